"""Start processes and measure their time and peak memory.

The peak that the kernel reports for a process is at least that of the process
that forked it. So a small server starts them: this file, run as a program,
which imports little. It reads one request a line and answers with one line,
both JSON.
"""
import json
import os
import signal
import subprocess
import sys
import time


class Failed(Exception):
    """A process did not end with status 0; the last words that it printed."""

    def __init__(self, why, late=False):
        super().__init__(why)
        self.late = late  # it was stopped


class Stopwatch:
    """Runs one command after the other and returns {wall, cpu, peak, out}:
    seconds, processor seconds of all its processes, bytes of the largest of
    them, and the text of standard output."""

    def __init__(self):
        self.cpu = 0.0  # of all that ran
        self.server = subprocess.Popen(
            ["/usr/bin/python3", "-S", "-E", __file__], text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def __call__(self, command, environment, folder, limit=3600.0):
        request = {"command": [str(word) for word in command],
                   "environment": environment, "folder": str(folder),
                   "limit": limit}
        self.server.stdin.write(json.dumps(request) + "\n")
        self.server.stdin.flush()
        line = self.server.stdout.readline()
        if not line:
            raise RuntimeError("the process that starts others has ended")
        answer = json.loads(line)
        self.cpu += answer.get("cpu", 0.0)
        if answer["status"] != 0:
            raise Failed(answer["why"], answer.get("late", False))
        return answer

    def close(self):
        """End the server, and a command that still runs."""
        self.server.stdin.close()
        self.server.terminate()
        self.server.wait()


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1][:200] if lines else "it said nothing"


def explain(status, error):
    if os.WIFSIGNALED(status):
        return f"ended by signal {os.WTERMSIG(status)}"
    return f"status {os.WEXITSTATUS(status)}: {last_line(error)}"


def run(request):
    """Run a command. Its output goes to files, as a pipe could fill up."""
    out, err = (os.memfd_create(name) for name in ("out", "err"))
    os.chdir(request["folder"])
    actions = [(os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0),
               (os.POSIX_SPAWN_DUP2, out, 1), (os.POSIX_SPAWN_DUP2, err, 2)]
    began = time.monotonic()
    try:
        child = os.posix_spawnp(
            request["command"][0], request["command"],
            request["environment"], file_actions=actions, setpgroup=0,
            setsigdef=[signal.SIGINT, signal.SIGPIPE])  # Python ignores both
    except OSError as error:
        return {"status": 127, "why": f"{request['command'][0]}: "
                                      f"{error.strerror}"}

    def stop(*_):
        os.killpg(child, signal.SIGKILL)
        nonlocal late
        late = True

    def give_up(*_):
        os.killpg(child, signal.SIGKILL)
        os._exit(143)

    late = False
    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, request["limit"])
    signal.signal(signal.SIGTERM, give_up)
    _, status, used = os.wait4(child, 0)
    wall = time.monotonic() - began
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    text = [os.pread(f, os.fstat(f).st_size, 0).decode(errors="replace")
            for f in (out, err)]
    os.close(out)
    os.close(err)
    answer = {"status": status, "wall": wall,
              "cpu": used.ru_utime + used.ru_stime,
              "peak": 1024 * used.ru_maxrss, "out": text[0]}
    if status != 0:
        answer["late"] = late
        answer["why"] = (f"took more than {request['limit']:.3g} s" if late
                         else explain(status, text[1] or text[0]))
    return answer


def serve():
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the harness hears it
    for line in sys.stdin:
        print(json.dumps(run(json.loads(line))), flush=True)


if __name__ == "__main__":
    serve()
