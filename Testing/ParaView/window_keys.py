# SPDX-License-Identifier: BSD-3-Clause
"""Keys and clicks of the X server itself (XTEST), for what ParaView's test scripts do not reach, as
shortcuts."""
import ctypes
import time

#: Shorter, and Qt may still be at work on the key before.
PAUSE = 0.2


class Keyboard:
    """Of the display of the environment. Raises OSError where libX11 or libXtst is missing."""

    def __init__(self):
        self.x11, self.xtst = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XStringToKeysym.restype = ctypes.c_ulong
        self.x11.XKeysymToKeycode.argtypes = [ctypes.c_void_p, ctypes.c_ulong]
        self.x11.XFlush.argtypes = [ctypes.c_void_p]
        pressed = [ctypes.c_void_p, ctypes.c_uint, ctypes.c_int, ctypes.c_ulong]
        self.xtst.XTestFakeKeyEvent.argtypes = self.xtst.XTestFakeButtonEvent.argtypes = pressed
        self.xtst.XTestFakeMotionEvent.argtypes = [ctypes.c_void_p, *3 * [ctypes.c_int],
                                                   ctypes.c_ulong]
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(None))

    def press(self, *names):
        """All at once, by the names of X11's keysyms."""
        codes = [self.x11.XKeysymToKeycode(self.display, self.x11.XStringToKeysym(name.encode()))
                 for name in names]
        for down, order in ((1, codes), (0, codes[::-1])):
            for code in order:
                self.xtst.XTestFakeKeyEvent(self.display, code, down, 0)
        self.x11.XFlush(self.display)
        time.sleep(PAUSE)

    def click(self, x, y, button=1):
        self.drag([(x, y)], button)

    def drag(self, places, button=1):
        """Pressed at the first place, released at the last."""
        for i, (x, y) in enumerate(places):
            self.xtst.XTestFakeMotionEvent(self.display, -1, int(x), int(y), 0)
            if i == 0:
                self.x11.XFlush(self.display)
                time.sleep(PAUSE)
                self.xtst.XTestFakeButtonEvent(self.display, button, 1, 0)
            self.x11.XFlush(self.display)
            time.sleep(PAUSE / 4)
        self.xtst.XTestFakeButtonEvent(self.display, button, 0, 0)
        self.x11.XFlush(self.display)
        time.sleep(PAUSE)

    def write(self, text):
        for letter in text:
            names = {".": "period", "-": "minus", "/": "slash", "_": "underscore"}
            name = names.get(letter, letter)
            shift = ("Shift_L",) if letter == "_" or letter.isupper() else ()
            self.press(*shift, name)
