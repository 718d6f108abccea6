"""Controls a headless Chromium by the DevTools protocol over a pipe. Read first: Chromium.

Chromium draws by its software renderer, so that no graphics card is needed."""
import base64
import fcntl
import json
import os
import shutil
import subprocess
import tempfile
import time

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")


def find():
    """Returns the path of the program; None if it is not installed."""
    return next((path for path in map(shutil.which, PROGRAMS) if path), None)


class Chromium:
    """A browser with one page. Ends at the end of a `with` statement."""

    def __init__(self, width, height):
        commands, self.commands = os.pipe()
        self.answers, answers = os.pipe()
        self.folder = tempfile.mkdtemp()
        self.process = subprocess.Popen(
            [find(), "--headless", "--no-sandbox", "--remote-debugging-pipe", "--no-first-run",
             "--disable-extensions", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--user-data-dir=" + self.folder, "about:blank"],
            preexec_fn=lambda: self._use_pipes(commands, answers), close_fds=False,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(commands)
        os.close(answers)
        self.received, self.number, self.session, self.events = b"", 0, None, []
        page = next(target for target in self.call("Target.getTargets")["targetInfos"]
                    if target["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=page["targetId"],
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(domain + ".enable")
        self.resize(width, height)

    @staticmethod
    def _use_pipes(commands, answers):
        """Makes the pipes the files 3 and 4 of the new process, as the protocol has it."""
        free = 10
        copies = [fcntl.fcntl(file, fcntl.F_DUPFD, free) for file in (commands, answers)]
        os.dup2(copies[0], 3)
        os.dup2(copies[1], 4)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.commands)
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.answers)
        shutil.rmtree(self.folder, ignore_errors=True)

    def _receive(self):
        while b"\0" not in self.received:
            part = os.read(self.answers, 1 << 20)
            if not part:
                raise EOFError("Chromium has ended")
            self.received += part
        message, self.received = self.received.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        """Returns the result of a method of the protocol."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        rest = json.dumps(message).encode() + b"\0"
        while rest:
            rest = rest[os.write(self.commands, rest):]
        while True:
            answer = self._receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def resize(self, width, height, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=2 if mobile else 1, mobile=mobile)

    def open(self, path, fragment=""):
        self.call("Page.navigate", url=f"file://{path}{fragment}")

    def evaluate(self, script):
        """Returns the value of a script."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']['exception']['description']}")
        return answer["result"].get("value")

    def wait(self, condition, seconds=60):
        """Waits until a script is true. Raises TimeoutError."""
        end = time.monotonic() + seconds
        while not self.evaluate(condition):
            if time.monotonic() > end:
                raise TimeoutError(f"not within {seconds} s: {condition}")
            time.sleep(0.1)

    def press(self, key):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key)

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def console(self):
        """Returns (level, text) of what the page has logged, errors and warnings of the browser
        included."""
        lines = []
        for event in self.events:
            method, parameters = event.get("method"), event.get("params")
            if method == "Runtime.consoleAPICalled":
                lines.append((parameters["type"],
                              " ".join(str(value.get("value")) for value in parameters["args"])))
            elif method == "Runtime.exceptionThrown":
                lines.append(("error", json.dumps(parameters["exceptionDetails"])))
            elif method == "Log.entryAdded":
                lines.append((parameters["entry"]["level"], parameters["entry"]["text"]))
        return lines

    def screenshot(self):
        """Returns the bytes of a PNG of the page."""
        return base64.b64decode(self.call("Page.captureScreenshot")["data"])
