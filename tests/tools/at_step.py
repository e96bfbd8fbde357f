"""Send a signal to a tool at a step of its work.

at_step.py SIGNAL STEP COMMAND...: run the command with a pseudo terminal as
standard error, where it shows its progress, and send it the signal when the
terminal shows the step. What the terminal has shown is printed in the end, and
the status is that of the command, 128 + N after signal N. If the command ends
without the step, no signal is sent.
"""

import os
import signal
import subprocess
import sys


def main(name, step, *command):
    number = signal.Signals["SIG" + name]
    # whoever started the test may ignore it (nohup; a shell in the background),
    # and a tool would go on to ignore it
    signal.signal(number, signal.SIG_DFL)
    here, there = os.openpty()
    run = subprocess.Popen(command, stderr=there)
    os.close(there)
    shown, sent = b"", False
    while True:
        try:
            piece = os.read(here, 4096)
        except OSError:  # EIO: the command has ended
            break
        shown += piece
        if not sent and step.encode() in shown:
            run.send_signal(number)
            sent = True
    status = run.wait()
    print(shown.decode().replace("\r\033[K", "\n").replace("\r", ""))
    return status if status >= 0 else 128 - status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
