"""Do something to a tool at a step of its work.

at_step.py ACTION STEP [+ ACTION STEP]... COMMAND...: run the command with a
pseudo terminal as standard error, where it shows its progress, and carry out
the action when the terminal shows the step, then the next one. An action is

    INT, TERM, HUP  this signal
    away:FOLDER     remove the folder
    back:FOLDER     make it

or several with commas between. What the terminal has shown is printed in the
end, and the status is that of the command, 128 + N after signal N. If the
command ends without the step, nothing is done.
"""

import os
import shutil
import signal
import subprocess
import sys


def act(actions, run):
    for action in actions.split(","):
        kind, _, folder = action.partition(":")
        if kind == "away":
            shutil.rmtree(folder)
        elif kind == "back":
            os.mkdir(folder)
        else:
            run.send_signal(signal.Signals["SIG" + action])


def main(*words):
    todo, command = [words[:2]], words[2:]
    while command[0] == "+":
        todo.append(command[1:3])
        command = command[3:]
    # whoever started the test may ignore them (nohup; a shell in the
    # background), and a tool would go on to ignore them
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    here, there = os.openpty()
    run = subprocess.Popen(command, stderr=there)
    os.close(there)
    shown, seen = b"", 0
    while True:
        try:
            piece = os.read(here, 4096)
        except OSError:  # EIO: the command has ended
            break
        shown += piece
        while todo and todo[0][1].encode() in shown[seen:]:
            act(todo.pop(0)[0], run)
            seen = len(shown)
    status = run.wait()
    print(shown.decode().replace("\r\033[K", "\n").replace("\r", ""))
    return status if status >= 0 else 128 - status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
