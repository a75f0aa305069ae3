# SPDX-License-Identifier: BSD-3-Clause
"""Clicks in ParaView's window, written as the test scripts that ParaView plays
(paraview --test-script)."""
import os
import subprocess
import sys
from pathlib import Path
from xml.sax.saxutils import quoteattr

from versions import PLUGIN_FILE_DIALOG, SETTINGS, TOOLBAR

MAIN = "pqClientMainWindow/"
PROPERTIES = MAIN + "propertiesDock/propertiesPanel/"
PANEL = (PROPERTIES + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/"
         "PropertiesFrame/ProxyPanel/")
#: The first view's frame, and what is drawn in it.
FRAME = MAIN + ("centralwidget/MultiViewWidget/CoreWidget/qt_tabwidget_stackedwidget/"
                "MultiViewWidget1/Container/Frame.0/")
VIEW = FRAME + "CentralWidgetFrame/Viewport"
BROWSER = MAIN + "pipelineBrowserDock/pipelineBrowser"


#: The filters of the menu Mesh Morphing; those for one step of a morph have a menu of their own.
FIRST = ("MorphMesh", "FitToSurface", "RepairMesh", "ScaledJacobian", "CompareMorphMethods",
         "MorphShapes")


def field(name, value):
    """The panel's field of a number."""
    return f"{PANEL}{name}/{'Number' if isinstance(value, int) else 'DoubleLineEdit0'}"


def rows(names):
    """In the order of the table of surfaces: those that the file names, then by number."""
    def place(name):
        kind, _, number = name.partition(" ")
        numbered = kind in ("Surface", "Curve") and number.isdigit()
        return (1 + ("Surface", "Curve").index(kind), int(number)) if numbered else (0, 0)
    return sorted(names, key=place)


def category(name):
    """The menu of a filter of the plugin."""
    return "Mesh Morphing" if name in FIRST else "Mesh Morphing Steps"


HERE = Path(__file__).resolve().parent
#: Where pictures of the window are kept; none: no pictures.
SHOTS = os.environ.get("MESHMORPHING_SHOTS")
_taken = set()


def shot_name(step):
    """The name of a picture: the test's program and the step, a number added where it repeats."""
    words = "".join(c if c.isalnum() else " " for c in step).split()
    name = "-".join([Path(sys.argv[0]).stem, *words])
    count = 2
    while name in _taken:
        name, count = f"{name.rsplit('-again', 1)[0]}-again{count}", count + 1
    _taken.add(name)
    return name


def picture(step):
    """Of the whole screen at once, where a test presses real keys."""
    if SHOTS:
        Path(SHOTS).mkdir(parents=True, exist_ok=True)
        path = Path(SHOTS) / f"{shot_name(step)}.png"
        subprocess.run(["import", "-window", "root", str(path)], check=False)


class Events:
    """What a user does, in order, by the names of ParaView's widgets."""

    def __init__(self):
        self.lines = []
        self.shots = []  # names of pictures, in the order of the saved states

    def shot(self, step):
        """Keeps a picture of the whole window in SHOTS. ParaView's test scripts have no pause, so
        the picture is taken while a state is saved, which window_shots.py observes."""
        if SHOTS:
            name = shot_name(step)
            self.save_state(Path(SHOTS) / f"{name}.pvsm", name)

    def do(self, widget, command, argument=""):
        self.lines.append(f"<pqevent object={quoteattr(widget)} command={quoteattr(command)} "
                          f"arguments={quoteattr(argument)}/>")

    def expect(self, widget, argument, what="text"):
        self.lines.append(f"<pqcheck object={quoteattr(widget)} property={quoteattr(what)} "
                          f"arguments={quoteattr(argument)}/>")

    def menu(self, menu, action):
        """menu: "menuTools", or with a submenu "menuFilters/Alphabetical"."""
        self.do(MAIN + "menubar", "activate", menu.split("/")[0])
        self.do(MAIN + "menubar/" + menu, "activate", action)

    def load_plugin(self, path, side="Local"):
        """side: "Local" for this client, "Remote" for the server that it is connected to."""
        manager = MAIN + "PluginManagerDialog/"
        self.menu("menuTools", "actionManage_Plugins")
        self.do(manager + f"splitter/{side.lower()}Group/load{side}", "activate")
        self.do(manager + PLUGIN_FILE_DIALOG, "filesSelected", path)
        self.do(manager + "buttonBox/1QPushButton0", "activate")

    def open(self, path):
        self.do(MAIN + "MainControlsToolbar/actionOpenData", "activate")
        self.do(MAIN + "FileOpenDialog", "filesSelected", path)
        self.apply()

    def apply(self):
        self.do(PROPERTIES + "Accept", "activate")

    def select(self, place, browser=BROWSER):
        """place: as "/0:0/1:0", row 1 under row 0 of the pipeline browser."""
        for command, buttons in (("mousePress", "1,1"), ("mouseRelease", "1,0")):
            self.do(browser, command, f"{buttons},0,60,10,{place}")

    def toolbar(self, name):
        """A filter of FIRST, by its button."""
        self.do(f"{MAIN}{TOOLBAR}/1QToolButton{FIRST.index(name)}", "activate")

    def filter(self, name, menu=None):
        self.menu("menuFilters/" + (menu or category(name)), name)

    def choose_input(self, port, place):
        dialog = MAIN + "SelectInputDialog/"
        self.do(dialog + "buttonFrame/" + port, "set_boolean", "true")
        self.select(place, dialog + "pipelineView")
        self.accept_inputs()

    def accept_inputs(self):
        self.do(MAIN + "SelectInputDialog/buttonBox/1QPushButton0", "activate")

    def save_state(self, path, step=None):
        """`step`: the name of the picture that is taken then."""
        self.shots.append(step or shot_name(Path(path).stem))
        Events.menu(self, "menu_File", "actionFileSaveServerState")
        self.do(MAIN + "FileSaveServerStateDialog", "filesSelected", str(path))

    def select_cells(self, first, last):
        """By a rectangle in the view, from one corner to the other: (x, y) in parts of its size."""
        self.do(FRAME + "actionSelectSurfaceCells", "activate")
        for command, (x, y), buttons in (("mousePress", first, "1,1"), ("mouseMove", last, "0,1"),
                                         ("mouseRelease", last, "1,0")):
            self.do(VIEW, command, f"({x},{y},{buttons},0)")

    def press_in_view(self, place, button=1):
        """Without a move; place: (x, y) in parts of the view's size. Buttons: 1 left, 2 right."""
        for command, down in (("mousePress", button), ("mouseRelease", 0)):
            self.do(VIEW, command, f"({place[0]},{place[1]},{button},{down},0)")

    def set(self, name, command, value):
        """In the panel; name: of the property and its widget."""
        self.do(PANEL + name, command, value)

    def prepare(self, folder, size="1270 990", script=None, environment=None, arguments=()):
        """Writes the events and ParaView's settings into `folder`; returns the arguments of
        subprocess.Popen that play them, after the Python script `script`, if any. `arguments`: of
        ParaView."""
        settings = folder / ".config/ParaView" / SETTINGS
        settings.parent.mkdir(parents=True)
        settings.write_text("[General]\nGeneralSettings.ShowWelcomeDialog=false\n"
                            f"[MainWindow]\nSize=@Size({size})\nPosition=@Point(0 0)\n",
                            encoding="utf-8")
        played = folder / "events.xml"
        played.write_text("\n".join(['<?xml version="1.0"?>', "<pqevents>", *self.lines,
                                     "</pqevents>"]), encoding="utf-8")
        folder.chmod(0o700)
        # Without DASHBOARD_TEST_FROM_CTEST ParaView asks whether to save the session when it
        # leaves.
        environment = {**os.environ, **(environment or {}), "HOME": str(folder),
                       "XDG_RUNTIME_DIR": str(folder), "DASHBOARD_TEST_FROM_CTEST": "1"}
        environment.pop("PV_PLUGIN_PATH", None)
        if SHOTS:
            Path(SHOTS).mkdir(parents=True, exist_ok=True)
            environment["MORPH_SHOTS"] = "\n".join(str(Path(SHOTS) / name) for name in self.shots)
            environment["PYTHONPATH"] = os.pathsep.join(
                [str(HERE), *filter(None, [environment.get("PYTHONPATH")])])
            script = script or HERE / "window_shots.py"
        command = ["paraview", *arguments, *([f"--script={script}"] if script else []),
                   f"--test-script={played}"]
        return {"args": command, "env": environment, "cwd": folder, "text": True,
                "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}

    def play(self, folder, seconds=900, **options):
        """Plays the events in ParaView, with `folder` for its settings; returns its exit code and
        messages. `options`: of prepare()."""
        how = self.prepare(folder, **options)
        run = subprocess.run([*how.pop("args"), "--exit"], timeout=seconds, check=False, **how)
        for name in self.shots if SHOTS else ():
            (Path(SHOTS) / f"{name}.pvsm").unlink(missing_ok=True)
        return run.returncode, run.stdout
