#!/bin/sh
# The report of ritz-chart in a real browser: what it fetches, says, how it fits
# and what keys do. Usage: report.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
for program in gnuplot chromium; do
    command -v $program >/dev/null || {
        echo "ok 1 - the report works in a browser # SKIP $program is not" \
            "installed"
        echo '1..1'
        exit 0
    }
done

# --- a report of every kind of file ------------------------------------------

expect 0 '' import_body stator --port bearing=1 --input torque=1:6 \
    --input push=1:1 --output-at turn=5:6 --output-at slide=5:1 -o stator.h5
for method in craig-bampton macneal-rubin; do
    for modes in 2 4 8; do
        ritz-basis $method --modes $modes --attach bearing -q stator.h5 \
            -o basis.h5 --record runs.jsonl
        ritz-reduce -q stator.h5 basis.h5 -o $method.h5 --record runs.jsonl
        ritz-verify -q --band-hz 0,15 stator.h5 $method.h5 -o verified.h5 \
            --damping 'modal 0.01' --record runs.jsonl
    done
done
ritz-frf -q --from-hz 1 --to-hz 40 --damping 'modal 0.01' --singular-values \
    stator.h5 -o full.h5
ritz-frf -q --points-of full.h5 --damping 'modal 0.01' --singular-values \
    craig-bampton.h5 -o r.h5
ritz-rank -q craig-bampton.h5 --damping 'modal 0.01' -o ranking.h5
printf 'track\tconfiguration\tmode\thertz\tmac\n' >tracks.tsv
printf '1\tclock=%d\t1\t%s\t%s\n' 0 1.5 nan 60 1.7 0.99 120 1.6 0.7 \
    >>tracks.tsv
expect 0 '' ritz-chart report runs.jsonl full.h5 r.h5 ranking.h5 tracks.tsv \
    craig-bampton.h5 macneal-rubin.h5 -o report.html

# nothing in it names another file or place, but for the names of XML itself
if grep -oE "(src|href|url|action)[=(][\"']?[^#\"' )>]+" report.html |
    grep -v '^href=$' >log; then
    report no 'the page refers to nothing outside'
else
    report yes 'the page refers to nothing outside'
fi
expect 0 "default-src 'none'" cat report.html
expect 0 '' /usr/bin/python3 -s - <<'END'
import html.parser
class Check(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.levels, self.refs = [], [], []
    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if "id" in attrs:
            self.ids.append(attrs["id"])
        for key in ("aria-labelledby",):
            self.refs += attrs.get(key, "").split()
        if attrs.get("href", attrs.get("xlink:href", "")).startswith("#"):
            self.refs.append(attrs.get("href", attrs.get("xlink:href"))[1:])
        if tag in ("h1", "h2", "h3"):
            self.levels.append(int(tag[1]))
c = Check()
c.feed(open("report.html").read())
assert len(c.ids) == len(set(c.ids)), "an id is there twice"
assert set(c.refs) <= set(c.ids), set(c.refs) - set(c.ids)
assert c.levels[0] == 1 and c.levels.count(1) == 1
assert all(b <= a + 1 for a, b in zip(c.levels, c.levels[1:]))
END

# --- where nothing meets the tolerance -----------------------------------------

# record METHOD ORDER MISSING ERROR
record() {
    printf '{"method": "%s", "order": %s, "subject": "beam", "feasible": false,
 "tolerance": {"response-relative": 0.01}, "seconds": {"cpu": 0.1},
 "errors": {"missing-modes": %s, "response-relative": %s}}\n' "$@" |
        tr -d '\n'
    echo
}
{ record poor 3 0 0.5; record near 9 0 0.02; record far 12 0 0.4; } >unmet.jsonl
expect 0 '' ritz-chart report unmet.jsonl -o unmet.html
expect 0 '<div class="big">near</div>' cat unmet.html
expect 0 'this is the one that comes nearest to its tolerance' cat unmet.html
expect 0 'It misses a tolerance' cat unmet.html
# the headline is the measure asked for; a measure ten times worse is next to it
printf '{"method": "near", "order": 9, "subject": "beam", "chosen": true,
 "tolerance": {"frequency-relative": 0.01}, "seconds": {"cpu": 0.1},
 "errors": {"response-relative": 0.5, "frequency-relative": 0.004,
 "static-gain-relative": 0.03}}' | tr -d '\n' >asked.jsonl
expect 0 '' ritz-chart report asked.jsonl -o asked.html
expect 0 'How wrong</dt><dd><div class="big">0.4' cat asked.html
expect 0 'the worst of what was asked for: frequency error' cat asked.html
expect 0 'more than ten times that: response error 50' cat asked.html
works '  and nothing that is not' sh -c '! grep -q "times that: static" asked.html'
record lost 12 2 0.001 >lost.jsonl
expect 0 '' ritz-chart report lost.jsonl -o lost.html
expect 0 'none has a tolerance that its errors can be held against' cat lost.html

# --- in a browser -------------------------------------------------------------

# A page of our own shows the report in frames, drives it, and writes down what
# it found: the report itself needs nothing for that.
cat >drive.html <<'END'
<!doctype html><meta charset="utf-8">
<iframe id="w360" width="360" height="700" src="report.html"></iframe>
<iframe id="w768" width="768" height="700" src="report.html"></iframe>
<iframe id="w1600" width="1600" height="900" src="report.html"></iframe>
<script>
const found = {};
function light(text) {
    const rgb = text.match(/[\d.]+/g).slice(0, 3).map(function (v) {
        v /= 255;
        return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}
function contrast(a, b) {
    const x = light(a) + 0.05, y = light(b) + 0.05;
    return Math.max(x, y) / Math.min(x, y);
}
/* least contrast of words to what they stand on, and of marks to paper */
function contrasts(page) {
    const probe = page.createElement("p");
    page.body.append(probe);
    function colour(name) {
        probe.style.color = "var(" + name + ")";
        return page.defaultView.getComputedStyle(probe).color;
    }
    let words = 99, marks = 99;
    for (const name of ["--ink", "--muted", "--alarm", "--good", "--link"])
        for (const under of ["--paper", "--page"])
            words = Math.min(words, contrast(colour(name), colour(under)));
    for (let k = 1; k <= 8; k++)
        marks = Math.min(marks, contrast(colour("--c" + k), colour("--paper")));
    probe.remove();
    return [words, marks];
}
function key(target, name) {
    target.dispatchEvent(new KeyboardEvent("keydown",
        {key: name, bubbles: true, cancelable: true}));
}
addEventListener("load", function () {
    for (const frame of document.querySelectorAll("iframe")) {
        const page = frame.contentDocument, root = page.documentElement;
        found[frame.id] = root.scrollWidth - root.clientWidth;
        found.ready = root.dataset.ready;
        found.fetched = frame.contentWindow.performance
            .getEntriesByType("resource").length;
    }
    const page = document.getElementById("w1600").contentDocument;
    const picture = page.querySelector(".picture");
    const tip = page.getElementById("tip");
    const marks = picture.querySelectorAll(".mark");
    found.marks = marks.length;
    found.pictures = page.querySelectorAll("figure svg").length;
    found.named = page.querySelectorAll("figure svg > title").length;
    found.tables = page.querySelectorAll("figure details table").length;
    found.singular = page.body.textContent.includes("singular values: full.h5");
    found.equal = page.body.textContent.includes("lines of equal error");
    found.levels = 0;
    for (const row of page.querySelectorAll(".legend li"))
        found.levels += row.textContent === "equal error";
    found.charts = 0;
    found.legends = 0;
    for (const section of page.querySelectorAll("section")) {
        found.charts += section.querySelector("figure") !== null;
        found.legends = Math.max(found.legends,
            section.querySelectorAll(".legend").length);
    }
    /* what a legend calls a line or a mark, no picture says again */
    found.twice = 0;
    const charts = picture.closest("section");
    for (const row of charts.querySelectorAll(".legend li"))
        for (const word of charts.querySelectorAll(".picture text"))
            found.twice += word.textContent === row.textContent;
    found.whole = page.querySelectorAll(".whole").length;
    found.cut = [];
    found.bare = 0;
    const paper = page.defaultView
        .getComputedStyle(page.querySelector("figure")).backgroundColor;
    for (const drawing of page.querySelectorAll(".picture")) {
        const all = drawing.getBoundingClientRect();
        for (const word of drawing.querySelectorAll("text")) {
            const at = word.getBoundingClientRect();
            const style = page.defaultView.getComputedStyle(word);
            if (at.left < all.left - 1 || at.right > all.right + 1 ||
                at.top < all.top - 1 || at.bottom > all.bottom + 1)
                found.cut.push(word.textContent);
            if (style.fill !== paper && style.stroke !== paper)
                found.bare++;
        }
    }
    found.stops = picture.querySelectorAll("[tabindex='0']").length;
    found.hidden = tip.hidden;
    picture.querySelector("[tabindex='0']").focus();
    found.tip = tip.hidden ? "" : tip.textContent;
    key(page.activeElement, "ArrowRight");
    found.next = tip.textContent;
    found.label = page.activeElement.getAttribute("aria-label");
    key(page.activeElement, "Escape");
    found.closed = tip.hidden;
    const box = marks[0].getBoundingClientRect();
    picture.dispatchEvent(new PointerEvent("pointermove",
        {clientX: box.left, clientY: box.top, bubbles: true}));
    found.hovered = !tip.hidden;
    found.first = contrasts(page);
    const before = page.defaultView.getComputedStyle(page.body).backgroundColor;
    found.ground = light(before) > 0.5 ? "light" : "dark";
    page.getElementById("theme").click();
    found.turned =
        page.defaultView.getComputedStyle(page.body).backgroundColor !== before;
    found.second = contrasts(page);
    document.body.textContent = "FOUND" + JSON.stringify(found) + "END";
});
</script>
END
browse() {
    timeout 120 chromium --headless --no-sandbox --disable-gpu \
        --user-data-dir="$dir/profile" --allow-file-access-from-files \
        --enable-logging=stderr --window-size=1700,1000 "$@" 2>said
}
drive() {
    browse "$@" --dump-dom "file://$dir/drive.html" >dom || true
    tr -d '\n' <dom | sed -n 's/.*<body>FOUND\(.*\)END.*/\1/p' >log.json
    { cat said dom | tail -n 5; } >log
}
drive
holds 'the page runs and fetches nothing' '
    j["ready"] == "yes" and j["fetched"] == 0'
if grep -i 'console' said >log; then
    report no 'the browser has nothing to complain of'
else
    report yes 'the browser has nothing to complain of'
fi
holds 'nothing is wider than a page of 360, 768 or 1600 pixels' '
    j["w360"] <= 0 and j["w768"] <= 0 and j["w1600"] <= 0'
holds 'no word of a picture is cut' 'j["cut"] == []'
holds 'words on marks and lines have a rim' 'j["bare"] == 0'
holds 'equal error is said, and singular values are drawn' '
    j["equal"] and j["levels"] == 2 and j["singular"]'
holds 'a section has one legend for all its pictures' '
    j["charts"] >= 5 and j["legends"] == 1 and j["twice"] == 0'
holds 'a picture of several channels has the width of the page' '
    j["whole"] >= 1'
holds 'every picture has a name and a table' '
    j["pictures"] >= 6 and j["named"] == j["pictures"] == j["tables"]'
holds 'a picture is one stop of the tabulator, and arrows go on' '
    j["stops"] == 1 and j["marks"] == 6 and j["hidden"] and
    "order" in j["tip"] and j["next"] != j["tip"] and
    j["next"] == j["label"] and j["closed"]'
holds 'a pointer beside a point shows what it is' 'j["hovered"]'
holds 'it is light unless it is asked to be dark, and turns' '
    j["ground"] == "light" and j["turned"]'
holds 'words have a contrast of 4.5 and marks of 3, light and dark' '
    min(j["first"][0], j["second"][0]) >= 4.5 and
    min(j["first"][1], j["second"][1]) >= 3'
drive --blink-settings=preferredColorScheme=0
holds 'a system that is dark has a dark page, narrow and wide' '
    j["ground"] == "dark" and j["w360"] <= 0 and j["w768"] <= 0 and
    j["w1600"] <= 0'
holds '  with as much contrast, and light at a press of the button' '
    j["turned"] and min(j["first"][0], j["second"][0]) >= 4.5 and
    min(j["first"][1], j["second"][1]) >= 3'
browse --no-pdf-header-footer --print-to-pdf="$dir/report.pdf" \
    "file://$dir/report.html" >/dev/null || true
expect 0 '%PDF' head -c 8 report.pdf
echo "1..$count"
