# SPDX-License-Identifier: BSD-3-Clause
"""A user of ParaView's window with a real mouse and keyboard (window_keys.py): what is asked for by
its name is found on the screen (window_places.cxx), and pressed there. A press and release, a drag,
a text that is typed, and a key count one each; the wheel counts nothing.

paraview --script runs it, too: it loads the plugin, and answers where things are."""
import ctypes
import json
import os
import subprocess
import sys
import time
from pathlib import Path


ROW = 22    # pixels, of a pipeline browser
DOCK = 420  # of the panel


class Hands:
    """`folder`: for ParaView's settings and the questions. Raises OSError as Keyboard does."""

    def __init__(self, folder):
        from window_events import Events
        from window_keys import Keyboard
        self.keyboard = Keyboard()
        self.asked = folder / "asked"
        self.count = 0
        home = folder / "home"
        home.mkdir()
        how = Events().prepare(home, script=Path(__file__).resolve(),
                               environment={"MORPH_ASKED": str(self.asked)})
        how["args"] = [one for one in how["args"] if not one.startswith("--test-script")]
        self.log = open(folder / "messages.txt", "w", encoding="utf-8")
        how["stdout"] = self.log
        self.paraview = subprocess.Popen(how.pop("args"), **how)
        self.find("button\tMorph Mesh", seconds=200, enabled=False)

    def messages(self):
        self.log.flush()
        return Path(self.log.name).read_text(encoding="utf-8")

    def close(self):
        self.paraview.kill()
        self.paraview.wait()
        self.log.close()

    def ask(self, question, seconds=300):
        answer = Path(f"{self.asked}.answer")
        answer.unlink(missing_ok=True)
        made = Path(f"{self.asked}.new")
        made.write_text(question, encoding="utf-8")
        made.rename(self.asked)
        end = time.time() + seconds
        while not answer.exists():
            if time.time() > end or self.paraview.poll() is not None:
                raise AssertionError(f"no answer to {question!r}, exit code {self.paraview.poll()}:"
                                     f"\n{self.messages()}")
            time.sleep(0.02)
        return json.loads(answer.read_text(encoding="utf-8"))

    def busy(self):
        """Whether it gives no answer for a second."""
        try:
            self.ask("widget\tViewport", seconds=1)
        except AssertionError:
            return self.paraview.poll() is None
        return False

    def find(self, question, seconds=300, enabled=True):
        """Once it is there and, if asked for, enabled: the window is then idle."""
        end = time.time() + seconds
        before = None
        while True:
            place = self.ask(question, seconds)
            if place and (place["enabled"] or not enabled) and place == before:
                return place  # and it stays there
            before = place
            if time.time() > end:
                picture("failed")
                raise AssertionError(f"{question!r} is not on the screen: {place}")
            time.sleep(0.2)

    def press_at(self, place, x=0.5, y=0.5, button=1):
        """`x`, `y`: in parts of the place, or of pixels from its left where above 1."""
        self.keyboard.click(place["x"] + (x if x > 1 else x * place["width"]),
                            place["y"] + y * place["height"], button)
        self.count += 1

    def press(self, widget, **where):
        self.press_at(self.find(f"widget\t{widget}"), **where)

    def button(self, text):
        self.press_at(self.find(f"button\t{text}"))

    def row(self, widget, text, **where):
        self.press_at(self.find(f"row\t{widget}\t{text}"), **where)

    def browser_row(self, row, browser="pipelineBrowser"):
        """Of a pipeline browser, which is none of Qt's lists: rows have one height."""
        place = self.find(f"widget\t{browser}")
        self.keyboard.click(place["x"] + 90, place["y"] + ROW * (row + 0.5) + 2)
        self.count += 1

    def tick(self, widget, text):
        """The box at the left of a row."""
        self.row(widget, text, x=12)

    def choose(self, widget, text):
        """An entry of a list: two presses."""
        self.press(widget)
        self.press_at(self.find(f"entry\t{text}"))

    def entry(self, text):
        self.press_at(self.find(f"entry\t{text}"))

    def type(self, text, *keys):
        """A value, with the key that ends it."""
        self.keyboard.write(text)
        for key in keys:
            self.keyboard.press(key)
        self.count += 1

    def fill(self, widget, text):
        """A field, behind what it has: zero."""
        self.press(widget, x=0.3)
        self.type(text)

    def key(self, *names):
        self.keyboard.press(*names)
        self.count += 1

    def view(self, place):
        area = self.find("widget\tViewport")
        return (area["x"] + place[0] * area["width"], area["y"] + place[1] * area["height"])

    def press_in_view(self, place, button=1):
        self.keyboard.click(*self.view(place), button)
        self.count += 1

    def drag(self, first, last, button=1, steps=10):
        """In the view; places in parts of its size."""
        path = [tuple(a + (b - a) * i / steps for a, b in zip(first, last))
                for i in range(steps + 1)]
        self.keyboard.drag([self.view(place) for place in path], button)
        self.count += 1

    def slide(self, widget, part, steps=8):
        """From the middle of a slider to a part of its length."""
        place = self.find(f"widget\t{widget}")
        x, y = place["x"] + place["width"] / 2, place["y"] + place["height"] / 2
        way = place["width"] * (part - 0.5)
        self.keyboard.drag([(x + way * i / steps, y) for i in range(steps + 1)])
        self.count += 1

    def text(self, widget):
        return self.find(f"widget\t{widget}", enabled=False)["text"]

    def wait(self, widget, accept, seconds=300):
        """The text of a widget once `accept` takes it."""
        end = time.time() + seconds
        while True:
            text = self.text(widget)
            if accept(text):
                return text
            if time.time() > end:
                picture("failed")
                raise AssertionError(f"{widget} has {text!r}:\n{self.messages()}")
            time.sleep(0.2)


def picture(step):
    from window_events import picture as take
    take(step)


if "MORPH_ASKED" in os.environ:
    from paraview import simple
    simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False)
    ctypes.CDLL(os.environ["MESHMORPHING_PANEL_ROWS"]).serve_places(
        os.environ["MORPH_ASKED"].encode(), DOCK)
elif __name__ == "__main__":
    sys.exit("window_hand_tasks.py uses it")
