# SPDX-License-Identifier: BSD-3-Clause
"""Every property of every proxy of the plugin: documented, set to another value than its default,
and found again in the VTK object, which prints its parameters. Server-manager XML is not compiled,
and nothing else reads all of it.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_XML=<its XML files, : between>
         pvpython properties.py
"""
import math
import os
import re
import sqlite3
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from paraview import simple

from versions import number_points
from window_events import FIRST, category

WIDGETS = Path(__file__).resolve().parents[2] / "Plugin/Widgets"
simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())


def icons():
    """Of the plugin's resources, those that are there."""
    files = ElementTree.parse(WIDGETS / "MeshMorphing.qrc").getroot().iter("file")
    return [f.get("alias") for f in files if (WIDGETS / f.text).is_file()]


def proxies():
    """The XML element of each filter's proxy; solver_files.py has the reader and the writer."""
    found = []
    for path in os.environ["MESHMORPHING_XML"].split(":"):
        found += ElementTree.parse(path).getroot().findall("ProxyGroup[@name='filters']/*")
    return found


def properties(proxy):
    return [p for p in proxy if p.tag.endswith("VectorProperty")]


def printed(filter_proxy, name):
    """What the VTK object prints for a parameter: the text after "name: "."""
    text = str(filter_proxy.GetClientSideObject())
    match = re.search(rf"^ *{name}: (.*)$", text, re.MULTILINE)
    assert match, f"{name} is not in:\n{text}"
    return match.group(1)

#: Limits of memory and lengths, which have no end, and tolerances, which span decades.
WITHOUT_SLIDER = ("StepMemoryLimit", "MemoryLimit", "Tolerance", "HandleRadius",
                  "ContactDistance", "Dimension", "HandleSmoothing", "LatticeLength")
#: What widgets of the panel are made from; not among its results.
FOR_WIDGETS = ("SurfaceList", "SurfaceSizes", "SurfaceShapes", "SurfaceBounds", "ZoneList",
               "ZoneSizes", "PickedSurfaces", "ValidWeights", "Advice", "LatticePoints",
               "Messages")


def results(*sections):
    """The rows of these sections of Results.txt that have a property, by their group."""
    rows, section = {}, None
    with open(os.path.join(os.path.dirname(__file__), "../../Filters/Morphing/Results.txt"),
              encoding="utf-8") as table:
        for line in table:
            if line.startswith("["):
                section = line.strip()[1:-1]
            elif line.strip() and line[0] != "#" and section in sections:
                name, _, _, _, group, panel, documentation = line.rstrip().split(None, 6)
                rows.setdefault(group, []).append((name, panel, documentation))
    rows.pop("-", None)
    return rows


def another_value(xml, filter_proxy):
    """A legal value that is not the property's default."""
    default = xml.get("default_values")
    if xml.tag == "StringVectorProperty":
        chosen = filter_proxy.GetProperty(xml.get("name"))
        if not hasattr(chosen, "GetAvailable"):
            return "another name"
        return [v for v in chosen.GetAvailable() if v != default][0]
    if xml.find("EnumerationDomain") is not None:
        return next(int(e.get("value")) for e in xml.find("EnumerationDomain")
                    if e.get("value") != default)
    if xml.find("BooleanDomain") is not None:
        return 1 - int(default)
    per_command = xml.get("number_of_elements_per_command")
    if xml.get("repeat_command") and xml.tag == "DoubleVectorProperty":
        return [0.5 + 0.125 * i for i in range(2 * int(per_command))]
    if int(xml.get("number_of_elements")) > 1 and xml.tag == "IntVectorProperty":
        return [int(v) + i + 1 for i, v in enumerate(default.split())]
    if int(xml.get("number_of_elements")) > 1:
        return [0.5 * float(v) + 0.125 * (i + 1) for i, v in enumerate(default.split())]
    if xml.tag == "DoubleVectorProperty":
        return 0.5 * float(default) if abs(float(default)) > 1e200 else 0.5 * float(default) + 0.125
    return int(default) + 3


def same(value, text):
    if isinstance(value, str):
        return value == text
    if isinstance(value, list):
        return len(value) == len(text.split()) and all(map(same, value, text.split()))
    # ParaView holds no NaN: -1 says that there is no value.
    return math.isclose(value, float(text), rel_tol=1e-4) or (value == -1 and "nan" in text)


class Properties(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        wavelet = simple.Wavelet(WholeExtent=[0, 4, 0, 4, 0, 4])
        # Some properties choose among cell arrays, point vectors and zones.
        numbered = number_points(Input=simple.AppendDatasets(Input=[wavelet]))
        marked = simple.Calculator(Input=numbered, Function="if(coordsX > 2, 1, 0)",
                                   ResultArrayName="Marked")
        grid = simple.Calculator(Input=marked, Function="jHat*coordsX", ResultArrayName="Vectors")
        boundary = simple.Calculator(Input=ExtractMorphBoundary(Input=grid),
                                     Function="iHat*coordsX*0.1", ResultArrayName="Shift")
        boundary.UpdatePipeline()
        target = ExtractMorphBoundary(Input=grid)
        cls.inputs = {"Input": grid, "Boundary": boundary, "Target": target, "Gradient": boundary,
                      "Shapes": boundary, "Field": boundary}

    def create(self, xml):
        names = [p.get("name") for p in xml.iter("InputProperty")]
        create = globals()[xml.get("label").replace(" ", "")]
        # A selection and a table are optional, and none of the other properties depends on them.
        return create(**{name: self.inputs[name] for name in names
                         if name not in ("Selection", "ZoneSelection", "ControlPoints", "Table")})

    def test_every_proxy_has_texts_and_a_place_in_the_menu(self):
        self.assertGreaterEqual(len(proxies()), 3)
        menu = ElementTree.parse(WIDGETS / "Menu.xml").getroot()
        menus = {proxy.get("name"): part.get("name") for part in menu for proxy in part}
        first = menu.find("Category")
        self.assertEqual([proxy.get("name") for proxy in first], list(FIRST))
        self.assertEqual((first.get("show_in_toolbar"), first.get("preserve_order")), ("1", "1"))
        for xml in proxies():
            with self.subTest(proxy=xml.get("name")):
                documentation = xml.find("Documentation")
                self.assertTrue(documentation.text.strip())
                self.assertTrue(documentation.get("short_help"))
                self.assertTrue(documentation.get("long_help"))
                icon = xml.find("Hints/ShowInMenu").get("icon")
                self.assertIn(icon.replace(":/MeshMorphing/Icons/", ""), icons())
                self.assertEqual(menus.pop(xml.get("name")), category(xml.get("name")))
                for p in list(xml.iter("InputProperty")) + properties(xml):
                    text = p.findtext("Documentation", "")
                    self.assertTrue(text.strip(), p.get("name"))
                    # reStructuredText: an indented line would start a quotation.
                    self.assertFalse([line for line in text.splitlines()[1:-1] if line[:1] == " "],
                                     p.get("name"))
        self.assertEqual(menus, {})

    def test_labels_are_english(self):
        """What the panel shows: a label of its own, or the name with spaces."""
        own = {}
        for xml in proxies():
            for p in properties(xml):
                hint = p.find("Hints/PropertyWidgetDecorator[@type='PanelLabel']")
                name = p.get("label") or re.sub("(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ",
                                                p.get("name"))
                if p.get("label"):  # Python calls the property by it
                    self.assertEqual(p.get("label").replace(" ", ""), p.get("name"))
                label = hint.get("text") if hint is not None else name
                self.assertNotRegex(label, r"\b[B-Zb-z]\b")
                if hint is not None:
                    self.assertEqual(own.setdefault(p.get("name"), label), label)
        self.assertEqual(own["TargetAngle"], "Target Angle (degrees)")
        self.assertEqual(own["MorphStatus"], "Status")

    def test_results_come_last_and_the_status_first(self):
        tested = 0
        for xml in proxies():
            groups = [group.get("label") for group in xml.iter("PropertyGroup")]
            if "Result" in groups and "MorphStatus" in {
                    p.get("name") for p in properties(xml)}:
                tested += 1
                with self.subTest(proxy=xml.get("name")):
                    results_group = [p.get("name") for group in xml.findall(
                        "PropertyGroup[@label='Result']") for p in group.iter("Property")]
                    self.assertIn("MorphStatus", results_group)
                    names = [p.get("name") for p in xml if p.get("name")]
                    inputs = [p.get("name") for p in properties(xml)
                              if p.get("information_only") != "1"]
                    self.assertLess(max(names.index(name) for name in inputs),
                                    names.index("MorphStatus"))
                    # A group of the panel is where the first of its properties is.
                    found = {p.get("name") for p in properties(xml)
                             if p.get("information_only") == "1"} - {"Advice"}
                    for group in xml.iter("PropertyGroup"):
                        kinds = {p.get("name") in found for p in group.iter("Property")}
                        self.assertLessEqual(len(kinds), 1, group.get("label"))
        self.assertGreaterEqual(tested, 9)

    def test_numbers_with_a_range_have_a_slider(self):
        for xml in proxies():
            for p in xml.findall("DoubleVectorProperty[@name='ScaleFactor']"):
                domain = p.find("DoubleRangeDomain")
                self.assertEqual((domain.get("min"), domain.get("max")), ("0", "1"))
            # ParaView gives a number a slider where its domain has both ends.
            for p in properties(xml):
                domain = p.find("DoubleRangeDomain")
                if p.get("panel_widget") or p.get("name") in WITHOUT_SLIDER or domain is None:
                    continue
                with self.subTest(proxy=xml.get("name"), property=p.get("name")):
                    self.assertLess(float(domain.get("min")), float(domain.get("max")))
            for p in xml.findall("DoubleVectorProperty[@name='MatchTolerance']"):
                self.assertEqual(p.find("DoubleRangeDomain").get("max"), "1")
            for p in xml.findall("IntVectorProperty[@name='NumberOfSteps']"):
                self.assertIn("1000000", p.findtext("Documentation"))

    def test_defaults_in_xml_are_those_of_the_class(self):
        for xml in proxies():
            for p in properties(xml):
                if (p.get("information_only") == "1" or p.tag == "StringVectorProperty"
                        or p.get("command") is None  # the window's own, unknown to the filter
                        or p.find("KnownBoundsDomain") is not None):  # it has the input's box
                    continue
                with self.subTest(proxy=xml.get("name"), property=p.get("name")):
                    default = [float(v) for v in (p.get("default_values") or "").split()]
                    self.assertTrue(same(default, printed(self.create(xml), p.get("name"))))

    def test_every_property_is_set_and_read_back(self):
        tested = 0
        for xml in proxies():
            for p in properties(xml):
                if p.get("information_only") == "1":
                    continue
                with self.subTest(proxy=xml.get("name"), property=p.get("name")):
                    filter_proxy = self.create(xml)
                    value = another_value(p, filter_proxy)
                    of_filter = p.get("command") is not None  # else the window's own
                    before = printed(filter_proxy, p.get("name")) if of_filter else None
                    setattr(filter_proxy, p.get("name"), value)
                    filter_proxy.UpdateVTKObjects()
                    if of_filter:
                        after = printed(filter_proxy, p.get("name"))
                        self.assertNotEqual(before, after)
                        self.assertTrue(same(value, after), f"{value} became {after}")
                    if p.find("KeptArraySelectionDomain") is not None:
                        self.assertEqual(list(getattr(filter_proxy, p.get("name"))), [value])
                    else:
                        first = value[0] if isinstance(value, list) else value
                        element = filter_proxy.SMProxy.GetProperty(p.get("name")).GetElement(0)
                        self.assertEqual(element, first)
                    tested += 1
        self.assertGreaterEqual(tested, 11)

    def test_every_number_in_the_panel_is_that_of_the_filter(self):
        for xml in proxies():
            filter_proxy = self.create(xml)
            if xml.get("name") == "MorphMesh":
                filter_proxy.Moving = "Everything"  # by default it has no numbers
            filter_proxy.UpdatePipeline()
            filter_proxy.UpdatePropertyInformation()
            for p in properties(xml):
                # Of the times, which ParaView's pipeline holds, the filter prints nothing.
                times = p.find("TimeStepsInformationHelper") is not None
                if (p.get("information_only") == "1" and p.tag != "StringVectorProperty"
                        and not times and p.get("name") not in FOR_WIDGETS):
                    with self.subTest(proxy=xml.get("name"), property=p.get("name")):
                        shown = getattr(filter_proxy, p.get("name"))
                        self.assertTrue(same(shown, printed(filter_proxy, p.get("name"))), shown)

    def test_results_of_the_panel_are_the_rows_of_their_table(self):
        with_results = 0
        for xml in proxies():
            sections = [xml.get("class")]
            if (xml.find("StringVectorProperty[@name='MorphStatus']") is not None
                    and xml.get("name") != "MorphShapes"):
                sections.append("vtkMorphAlgorithm")
            groups = results(*sections)
            if not groups or xml.get("base_proxyname"):  # that one has them
                continue
            with_results += 1
            with self.subTest(proxy=xml.get("name")):
                if xml.find("DoubleVectorProperty[@name='MaxTargetDistance']") is None:
                    groups.pop("Fit", None)  # of a filter that moves no boundary
                if "Solver" in groups:  # a result of every method, shown where there is a solver
                    solver = groups.pop("Solver")
                    if xml.find("IdTypeVectorProperty[@name='SolverIterations']") is not None:
                        groups["Solver"] = solver
                expected = sorted(row for rows in groups.values() for row in rows)
                shown = [(p.get("name"), p.get("panel_visibility"),
                          p.findtext("Documentation").strip())
                         for p in properties(xml)
                         if p.get("information_only") == "1"
                         and p.get("name") not in ("TimestepValues", *FOR_WIDGETS)]
                self.assertEqual(sorted(shown), expected)
                listed = [p.get("name") for group in xml.findall("PropertyGroup[@label='Result']")
                          for p in group.iter("Property")]
                self.assertEqual(sorted(listed), [row[0] for row in expected])
        self.assertEqual(with_results, 16)

    def test_every_filter_has_a_help_page(self):
        path = os.environ["MESHMORPHING_HELP"]
        if not path:
            self.skipTest("this ParaView builds no help pages of plugins")
        with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as help_file:
            pages = set(help_file.execute("select Name, Title from FileNameTable"))
        for proxy in proxies():
            self.assertIn((f"filters.{proxy.get('name')}.html", proxy.get("label")), pages)


if __name__ == "__main__":
    unittest.main()
