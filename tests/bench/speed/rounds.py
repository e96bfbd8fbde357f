"""Run all jobs on all models: once in the order of the table, as some jobs read
the results of others, then several rounds in random order."""
import random
import statistics

from stopwatch import Failed
from workshop import say

SEED = 15
QUICK_SECONDS = 230  # a further round does not begin if it would end later
KEYS = ("wall", "cpu", "peak")


def summary(values):
    return {"median": statistics.median(values), "least": min(values),
            "most": max(values), "runs": len(values)}


class Timing:
    def __init__(self, shop):
        self.shop = shop
        self.runs = {model: {} for model in shop.models}
        self.samples = {}

    def attempt(self, job, model):
        """Run a job once more; keep the sample, or the reason of its failure."""
        say(self.shop, model, job)
        try:
            done = self.shop.run(job, model)
        except Failed as reason:
            say(self.shop, model, f"{job}: {reason}")
            self.runs[model][job] = {"why": str(reason)}
            self.samples.pop((model, job), None)
        else:
            self.samples.setdefault((model, job), []).append(done)

    def first(self):
        for model in self.shop.models:
            for job, row in self.shop.jobs.items():
                reason = self.shop.why_not(job, model)
                lost = [other for other in row.get("after", [])
                        if (model, other) not in self.samples]
                if reason is None and lost:
                    reason = f"{lost[0]} did not run"
                if reason is None:
                    self.attempt(job, model)
                elif reason:
                    self.runs[model][job] = {"why": reason}

    def others(self):
        pairs = [pair for pair in self.samples
                 if not self.shop.jobs[pair[1]].get("once")]
        order = random.Random(SEED)
        lasts = sum(self.samples[pair][0]["wall"] for pair in pairs)
        for count in range(self.shop.repeats):
            began = self.shop.elapsed()
            if self.shop.quick and count > 0 and began + lasts > QUICK_SECONDS:
                say(self.shop, f"no time for more than {count} rounds")
                break
            order.shuffle(pairs)
            for model, job in pairs:
                if (model, job) in self.samples:
                    self.attempt(job, model)
            lasts = self.shop.elapsed() - began

    def finish(self):
        """Medians of all runs but the first, or of a single run."""
        for (model, job), samples in self.samples.items():
            counted = samples[1:] or samples
            run = {key: summary([done[key] for done in counted])
                   for key in KEYS}
            said = counted[-1].get("said", {})
            run["said"] = said
            if "phases" in said:
                run["phases"] = {name: statistics.median(
                    done["said"]["phases"].get(name, 0.0) for done in counted)
                    for name in said["phases"]}
            self.runs[model][job] = run
        return self.runs
