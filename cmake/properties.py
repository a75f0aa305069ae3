# SPDX-License-Identifier: BSD-3-Clause
"""Makes all that a property needs from Filters/Morphing/Properties.ini, which explains its keys.

    python3 cmake/properties.py cxx FOLDER   vtkX.h of vtkX.h.in, Options.h and Properties.cxx
    python3 cmake/properties.py xml FOLDER   ParaView's XML (X.xml.in of Plugin/X.xml.in)
    python3 cmake/properties.py options FILE the table of morph-mesh's options (PropertyTable.cxx)
    python3 cmake/properties.py tests FILE   what is one number, for the tests (PropertyRows.h),
                                             and the results of Results.txt beside it (ResultRows.h)
    python3 cmake/properties.py pages FOLDER the reference of each filter, for the site
    python3 cmake/properties.py python FILE  the methods of Python's package for NumPy (_methods.py)

A file whose text is the same stays as it is, so that nothing is compiled again."""

import configparser
import pathlib
import re
import sys
import textwrap

PROJECT = pathlib.Path(__file__).resolve().parent.parent
MODULE = PROJECT / "Filters" / "Morphing"
LISTS = {"surfaces": "Surface", "zones": "Zone"}  # sets of names that a list of the filter has
#: Groups of the panel that have no title; the others are folded, but a filter's first.
OPEN = ("What moves", "How it moves", "Boundary", "Method", "Motion", "Shapes")
KINDS = ("number", "numbers", "integer", "integers", "flag", "choice", "text", "array", *LISTS,
         "own")


class Row:
    """A property of a class: its keys, those for the class or its superclass first."""

    def __init__(self, name, section, classes):
        self.name = name
        self.keys = {}
        for key, value in section.items():
            if " of " not in key:
                self.keys[key] = value.strip()
        for one in reversed(classes):
            for key, value in section.items():
                if key.endswith(" of " + one):
                    self.keys[key[: -len(" of " + one)]] = value.strip()
        self.kind, _, count = self["type"].partition(" ")
        if self.kind not in KINDS:
            raise SystemExit(f"Properties.ini: {name} has no known type: {self['type']}")
        self.count = int(count or 1)
        self.values = [" ".join(v.split()) for v in self["values"].split("|") if v.strip()]
        self.default = self["default"] or {"flag": "0", "choice": (self.values or [""])[0]}.get(
            self.kind, "" if self.kind in ("text", "array", *LISTS, "own")
            else " ".join(["0"] * self.count))
        self.range = [None if v == "-" else v for v in (self["range"] or "- -").split()]
        self.paragraphs = [p.strip("\n") for p in re.split(r"\n\s*\n", self["text"])]

    def __getitem__(self, key):
        return self.keys.get(key, "")

    @property
    def words(self):
        """TargetReach: Target Reach"""
        return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", self.name)

    @property
    def default_number(self):
        return str(self.values.index(self.default)) if self.kind == "choice" else self.default

    @property
    def has_widget(self):
        """Of its own, in the panel."""
        return self["panel"] not in ("never", "table")

    @property
    def option(self):
        """Of morph-mesh; none: None."""
        if self["option"] == "-" or self.kind == "own":
            return None
        return self["option"] or "--" + self.words.lower().replace(" ", "-")


def read():
    table = configparser.ConfigParser(interpolation=None, delimiters=("=",))
    table.optionxform = str
    with open(MODULE / "Properties.ini", encoding="utf-8") as file:
        table.read_file(file)
    return table


def rows(table, classes):
    """Of a class, given with its superclasses, derived classes first."""
    return [Row(name, table[name], classes) for name in table.sections()
            if set(table[name]["filters"].split()) & set(classes)]


def proxy_rows(table, proxy, cls, superclasses):
    """Of a proxy of the plugin: those that name it or, if none does, all of its class."""
    classes = [proxy, cls, *superclasses]
    named = {row.name for row in rows(table, [proxy])} if proxy != cls else set()
    return [row for row in rows(table, classes) if not named or row.name in named]


def panel_order(own):
    """The groups that are always open, and the rows with these first, each group together."""
    groups = list(dict.fromkeys(row["group"] for row in own if row.has_widget))
    opened = {"", *[group for group in groups if group][:1], *OPEN}
    groups.sort(key=lambda group: group not in opened)
    place = {group: i for i, group in enumerate(groups)}
    return opened, sorted(own, key=lambda row: place.get(row["group"], -1))


def bases():
    """The superclasses of each class, the nearest first, without vtk."""
    nearest = {}
    for header in [*MODULE.glob("vtk*.h"), *MODULE.glob("vtk*.h.in")]:
        name = re.search(r"vtkTypeMacro\(vtk(\w+), vtk(\w+)\)", header.read_text(encoding="utf-8"))
        if name:
            nearest[name[1]] = name[2]
    chains = {}
    for cls in nearest:
        chain = [nearest[cls]]
        while chain[-1] in nearest:
            chain.append(nearest[chain[-1]])
        chains[cls] = chain
    return chains


def write(path, text):
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


# ---------------------------------------------------------------------------------------- C++


def constant(text):
    """Follow everywhere: FOLLOW_EVERYWHERE; SurfaceMethod: SURFACE_METHOD"""
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", text)
    return re.sub(r"[^A-Z0-9]+", "_", text.upper())


def camel(text):
    """Follow everywhere: FollowEverywhere"""
    return "".join(word[0].upper() + word[1:] for word in re.split(r"[^A-Za-z0-9]+", text) if word)


def constants(row):
    if row["prefix"] == "-":
        return []
    return [f"{row['prefix'] or constant(row.name)}_{constant(value)}" for value in row.values]


CXX_TYPES = {"number": "double", "integer": "int", "flag": "bool", "choice": "int",
             "text": "std::string", "array": "std::string",
             **dict.fromkeys(LISTS, "std::set<std::string>")}


def component_type(row):
    """Of kinds numbers and integers."""
    return CXX_TYPES[row.kind[:-1]]


def cxx_type(row):
    if row.kind in ("numbers", "integers"):
        return f"std::array<{component_type(row)}, {row.count}>"
    return CXX_TYPES[row.kind]


def integer_bounds(row):
    low, high = row.range
    return low or "VTK_INT_MIN", high or "VTK_INT_MAX"


def bounds_text(row):
    if row.kind not in ("number", "numbers", "integer", "integers") or row.range == [None, None]:
        return ""
    return ", range [{}, {}]".format(*integer_bounds(row))


def comment(row):
    """The documentation in the header."""
    lines = []
    for i, paragraph in enumerate(row.paragraphs):
        lines += [""] if i else []
        if paragraph.lstrip().startswith("|"):
            lines += [line.strip() for line in paragraph.splitlines()]
        else:
            lines += textwrap.wrap(" ".join(paragraph.split()), 95)
    default = {**dict.fromkeys(LISTS, "none"), "text": "none", "array": "none",
               "flag": "on" if row.default == "1" else "off"}.get(row.kind, row.default)
    last = textwrap.wrap(f"{lines.pop()} Default {default}{bounds_text(row)}.", 95)
    text = "\n".join(f"   * {line}".rstrip() for line in lines + last)
    return f"  ///@{{\n  /**\n{text}\n   */\n"


def results():
    """The rows of Results.txt: class, name, kind, value without a result, field, and text."""
    cls, made = "", []
    for line in (MODULE / "Results.txt").read_text(encoding="utf-8").splitlines():
        words = line.split(maxsplit=6)
        if line.startswith("["):
            cls = line.strip("[]")
        elif words and words[0] != "#" and words[1] != "counts":
            made.append((cls, *words[:4], words[6]))
    return made


def getters(cls, inherited):
    """The getters of the results of a class but those that a superclass declares."""
    sections = (cls, "vtkMorphAlgorithm") if cls == "vtkMorphMesh" else (cls,)
    made = ""
    for section, name, kind, none, _, text in results():
        if section not in sections or f" Get{name}()" in inherited:
            continue
        without = none.replace("nan", "NaN")
        said = "" if none == "kept" else f" Of the last execution; {without} without a result."
        lines = "\n".join(f"   * {line}" for line in textwrap.wrap(text + said, 95))
        made += f"  /**\n{lines}\n   */\n" + {
            "double": f"  double Get{name}() const {{ return this->GetNumber(\"{name}\"); }}\n",
            "id": f"  vtkIdType Get{name}() const {{ return this->GetInteger(\"{name}\"); }}\n",
            "int": f"  int Get{name}() const\n"
                   f"  {{\n    return static_cast<int>(this->GetInteger(\"{name}\"));\n  }}\n",
            "text": f"  const char* Get{name}() const {{ return this->GetText(\"{name}\"); }}\n",
            "count": f"  vtkIdType Get{name}() const {{ return this->GetCount(\"{name}\"); }}\n",
        }[kind] + "\n"
    return made.rstrip("\n")


def declarations(row):
    name = row.name
    if row.kind == "own":
        return ""
    text = ""
    names = constants(row)
    if names:
        entries = "".join(f"    {one} = {i},\n" for i, one in enumerate(names))
        text += f"  enum {name}Values\n  {{\n{entries[:-2]}\n  }};\n"
    text += comment(row)
    if row.kind in ("numbers", "integers"):
        one = component_type(row)
        arguments = ", ".join(f"{one} v{i}" for i in range(row.count))
        text += (f"  void Set{name}({arguments});\n"
                 f"  void Set{name}(const {one} values[{row.count}]);\n"
                 f"  {one}* Get{name}() VTK_SIZEHINT({row.count});\n"
                 f"  void Get{name}({one} values[{row.count}]);\n")
    elif row.kind in LISTS:
        text += (f"  void Set{name[:-1]}Status(const char* name, int status);\n"
                 f"  void Add{name[:-1]}(const char* name)\n"
                 f"  {{\n    this->Set{name[:-1]}Status(name, 1);\n  }}\n"
                 f"  void RemoveAll{name}();\n")
    elif row.kind in ("text", "array"):
        text += f"  void Set{name}(const char* value);\n  const char* Get{name}() const;\n"
    else:
        text += f"  void Set{name}({cxx_type(row)} value);\n  {cxx_type(row)} Get{name}() const;\n"
    if row.kind == "flag":
        text += f"  void {name}On() {{ this->Set{name}(true); }}\n"
        text += f"  void {name}Off() {{ this->Set{name}(false); }}\n"
    for i, value in enumerate(row.values):
        text += f"  void Set{name}To{camel(value)}() {{ this->Set{name}({i}); }}\n"
    return text + "  ///@}\n\n"


def member(row):
    default = row.default_number
    if row.kind == "flag":
        default = "true" if default == "1" else "false"
    elif row.kind in ("numbers", "integers"):
        default = "{ " + ", ".join(default.split()) + " }"
    elif row.kind not in ("number", "integer", "choice"):
        return f"  {cxx_type(row)} {row.name};\n"
    return f"  {cxx_type(row)} {row.name} = {default};\n"


def struct(name, all_rows):
    members = "".join(member(row) for row in all_rows)
    equal = " &&\n      ".join(f"a.{row.name} == b.{row.name}" for row in all_rows)
    return (f"struct {name}\n{{\n{members}\n"
            f"  friend bool operator==(const {name}& a, const {name}& b)\n  {{\n"
            f"    return {equal};\n  }}\n"
            f"  friend bool operator!=(const {name}& a, const {name}& b) {{ return !(a == b); }}\n"
            "};\n")


def definitions(cls, options, row):
    name, kept = row.name, f"this->{options}->{row.name}"
    low, high = row.range
    if row.kind in ("number", "numbers"):
        bounds = f"{low or '-Property::Any'}, {high or 'Property::Any'}"
    elif row.kind == "choice":
        bounds = f"0, {len(row.values) - 1}"
    else:
        bounds = ", ".join(integer_bounds(row))
    if row.kind in ("numbers", "integers"):
        one, n = component_type(row), row.count
        arguments = ", ".join(f"{one} v{i}" for i in range(n))
        values = ", ".join(f"v{i}" for i in range(n))
        parts = ", ".join(f"values[{i}]" for i in range(n))
        return (f"void {cls}::Set{name}({arguments})\n{{\n"
                f'  Property::Set(this, "{name}", {kept}, {{ {values} }}, {bounds});\n}}\n'
                f"void {cls}::Set{name}(const {one} values[{n}])\n"
                f"{{\n  this->Set{name}({parts});\n}}\n"
                f"{one}* {cls}::Get{name}()\n{{\n  return {kept}.data();\n}}\n"
                f"void {cls}::Get{name}({one} values[{n}])\n{{\n"
                f"  std::copy({kept}.begin(), {kept}.end(), values);\n}}\n")
    if row.kind in LISTS:
        return (f"void {cls}::Set{name[:-1]}Status(const char* name, int status)\n{{\n"
                f"  Property::SetStatus(this, {kept}, name, status);\n}}\n"
                f"void {cls}::RemoveAll{name}()\n{{\n  Property::Set(this, {kept}, {{}});\n}}\n")
    if row.kind in ("text", "array"):
        # ParaView's choice of an array offers None.
        set_to = "SetArray" if row.kind == "array" else "Set"
        return (f"void {cls}::Set{name}(const char* value)\n{{\n"
                f'  Property::{set_to}(this, {kept}, value ? value : "");\n}}\n'
                f"const char* {cls}::Get{name}() const\n{{\n  return {kept}.c_str();\n}}\n")
    call = f'this, "{name}", {kept}, value, {bounds}'
    if row.kind == "flag":
        call = f"this, {kept}, value"
    return (f"void {cls}::Set{name}({cxx_type(row)} value)\n{{\n  Property::Set({call});\n}}\n"
            f"{cxx_type(row)} {cls}::Get{name}() const\n{{\n  return {kept};\n}}\n")


def make_cxx(folder):
    table, superclasses = read(), bases()
    structs, sources, headers = [], [], []
    # Defaults that a class has on its own, where its superclass has the property.
    others = {}
    for name in table.sections():
        for key in table[name]:
            cls = key[len("default of "):]
            if (key.startswith("default of ") and cls not in table[name]["filters"].split() and
                    (MODULE / f"vtk{cls}.cxx").exists()):
                row = Row(name, table[name], [cls])
                others.setdefault(cls, []).append(row)
    for cls, own in others.items():
        members = "".join("  static constexpr" + member(row)[1:] for row in own)
        structs.append(f"/// Where they are not those of its superclass.\n"
                       f"struct {cls}Defaults\n{{\n{members}}};\n")
    for template in sorted(MODULE.glob("vtk*.h.in")):
        text = template.read_text(encoding="utf-8")
        cls = template.name[: -len(".h.in")]
        own = [row for row in rows(table, [cls[3:]]) if row.kind != "own"]
        kept = re.search(r"std::unique_ptr<morph::(\w+Options)> (\w+);", text)
        if not kept or text.count("@Properties@\n") != 1 or not own:
            raise SystemExit(f"{template}: it needs @Properties@, options, and rows in the table")
        made = "".join(declarations(row) for row in own).rstrip("\n")
        inherited = "".join((MODULE / f"vtk{base}.h.in").read_text(encoding="utf-8")
                            for base in superclasses[cls[3:]]
                            if (MODULE / f"vtk{base}.h.in").exists())
        write(folder / f"{cls}.h", text.replace("@Properties@", made).replace(
            "@Results@", getters(cls, inherited)))
        headers.append(f'#include "{cls}.h"\n')
        structs.append(struct(kept[1], own))
        print_one = "  Property::Print(os, indent, {0}, this->{1}->{2});\n"
        printed = "".join(print_one.format(f'"{row.name}"', kept[2], row.name) for row in own)
        # A class that declares PrintOptions() prints more than its options.
        function = ("PrintOptions(ostream& os, vtkIndent indent) const" if "PrintOptions(" in text
                    else "PrintSelf(ostream& os, vtkIndent indent)")
        begin = "" if "PrintOptions(" in text else "  this->Superclass::PrintSelf(os, indent);\n"
        sources.append("".join(definitions(cls, kept[2], row) for row in own) +
                       f"void {cls}::{function}\n{{\n{begin}{printed}}}\n")
    made = "// Made by cmake/properties.py from Properties.ini.\n"
    write(folder / "Private" / "Options.h",
          made + "#pragma once\n\n#include <array>\n#include <set>\n#include <string>\n\n"
          "namespace morph\n{\n" + "\n".join(structs) + "}\n")
    write(folder / "Properties.cxx",
          made + '#include "Private/Options.h"\n#include "Private/Pipeline/Property.h"\n' +
          "".join(headers) + "\n#include <algorithm>\n\n"
          "namespace Property = morph::filters::Property;\n\n"
          + "\n".join(sources))


# ---------------------------------------------------------------------------------------- XML


def escaped(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")


def condition(text, find):
    """PROPERTY: VALUE / VALUE, with & and | between several, as a decorator."""
    def one(part):
        name, _, values = part.partition(":")
        row = find(name.strip())
        numbers = [v.strip() for v in values.split("/")]
        if row.kind == "choice":
            # Of the values that this class has.
            numbers = [str(row.values.index(v)) for v in numbers if v in row.values]
        key = "value" if len(numbers) == 1 else "values"
        return (f'<PropertyWidgetDecorator type="GenericDecorator" mode="visibility" '
                f'property="{row.name}" {key}="{" ".join(numbers)}"/>')

    def several(parts, kind, inner):
        made = [inner(part) for part in parts]
        if len(made) == 1:
            return made[0]
        return f'<Expression type="{kind}">{"".join(made)}</Expression>'

    made = several(text.split("|"), "or", lambda part: several(part.split("&"), "and", one))
    if made.startswith("<Expression"):
        made = ('<PropertyWidgetDecorator type="CompositeDecorator">'
                f"{made}</PropertyWidgetDecorator>")
    return made


def with_parts(text):
    """Parts that several properties or proxies have in common: @Inputs@ is Morph/Inputs.xml."""
    for _ in range(2):  # a part may have parts
        for part in (PROJECT / "Plugin" / "Morph").glob("*.xml"):
            text = text.replace(f"@{part.stem}@\n", part.read_text(encoding="utf-8"))
    return text


def own_xml(row, classes, find):
    for name in [f"{cls}.{row.name}.xml" for cls in classes] + [f"{row.name}.xml"]:
        path = PROJECT / "Plugin" / "Properties" / name
        if path.exists():
            text = with_parts(path.read_text(encoding="utf-8"))
            return text.replace("@Shown@", condition(row["shown"], find) if row["shown"] else "")
    raise SystemExit(f"Plugin/Properties has no {row.name}.xml")


def domain(row):
    low, high = row["slider"].split() if " " in row["slider"] else row.range
    if row["slider"] == "no":
        high = None
    if row.kind == "flag":
        return '<BooleanDomain name="bool"/>'
    if row.kind == "choice":
        entries = "".join(f'<Entry value="{i}" text="{v}"/>' for i, v in enumerate(row.values))
        return f'<EnumerationDomain name="enum">{entries}</EnumerationDomain>'
    if row.kind == "array":
        port, name = row["array"].split()
        kind = "ArrayListDomain" if port == "Input" else "ConnectedArrayListDomain"
        return (f'<{kind} name="array_list" input_domain_name="{name}" none_string="None">'
                f'<RequiredProperties><Property function="Input" name="{port}"/>'
                f"</RequiredProperties></{kind}>")
    if row.kind in LISTS:
        return ('<KeptArraySelectionDomain name="list"><RequiredProperties>'
                f'<Property function="ArrayList" name="{LISTS[row.kind]}List"/>'
                "</RequiredProperties></KeptArraySelectionDomain>")
    if row["box"]:
        kind = {"corner": 'mode="normal" default_mode="min"',
                "lengths": 'mode="extents" default_mode="max"'}[row["box"]]
        return (f'<KnownBoundsDomain name="range" {kind}><RequiredProperties>'
                '<Property function="Input" name="Input"/>'
                "</RequiredProperties></KnownBoundsDomain>")
    if (low, high) == (None, None):
        return ""
    kind = "Int" if row.kind.startswith("integer") else "Double"
    least = f' min="{" ".join([low] * row.count)}"' if low else ""
    most = f' max="{" ".join([high] * row.count)}"' if high else ""
    return f'<{kind}RangeDomain name="range"{least}{most}/>'


def property_xml(row, find, more=""):
    kind = {"number": "Double", "numbers": "Double", "integer": "Int", "integers": "Int",
            "flag": "Int", "choice": "Int"}.get(row.kind, "String")
    if row.kind in LISTS:
        what = (f'command="Set{row.name[:-1]}Status" clean_command="RemoveAll{row.name}" '
                f'information_property="{LISTS[row.kind]}List" repeat_command="1" '
                'number_of_elements_per_command="2" element_types="2 0"')
        what += ' panel_widget="ZoneList"' if row.kind == "zones" else ""
    else:
        default = row.default_number or ("None" if row.kind == "array" else "")
        what = (f'command="Set{row.name}" number_of_elements="{row.count}" '
                f'default_values="{default}"')
    if row.name.isupper():  # else ParaView puts spaces between the letters
        what += f' label="{row.name}"'
    panel = row["panel"] if row.has_widget or row["panel"] == "never" else "default"
    visible = f' panel_visibility="{panel}"' if panel not in ("", "default") else ""
    animated = ' animateable="1"' if row["animated"] == "yes" else ""
    hints = []
    if row.kind in LISTS:
        hints.append("<OmitFromLoadAllVariables/>")
    if row.kind == "zones":
        hints.append('<ZoneList sizes="ZoneSizes" columns="Cells Nodes"/>')
    if row["shown"] and row.has_widget and not row["function"]:
        hints.append(condition(row["shown"], find))
    if row["unit"] or row.kind == "zones":  # these lists have no label of their own
        label = row.words + (f' ({row["unit"]})' if row["unit"] else "")
        hints.append(f'<PropertyWidgetDecorator type="PanelLabel" text="{label}"/>')
    if row["decorator"]:
        hints.append(f'<PropertyWidgetDecorator type="{row["decorator"]}"/>')
    if row["told"]:
        hints.append(f'<Told text="{row["told"]}"/>')
    hint = f"<Hints>{''.join(hints)}</Hints>" if hints else ""
    text = escaped(" ".join(row.paragraphs[0].split()))
    return (f'      <{kind}VectorProperty name="{row.name}" {what}{animated}{visible}{more}>\n'
            f"        {domain(row)}\n        <Documentation>\n{text}\n        </Documentation>\n"
            f"        {hint}\n      </{kind}VectorProperty>\n")


def make_xml(folder):
    table = read()
    chains = bases()
    for template in sorted((PROJECT / "Plugin").glob("*.xml.in")):
        text = template.read_text(encoding="utf-8")
        text = with_parts(text)
        # The last one: those before it are internal.
        proxy, cls = re.findall(r'<\w*SourceProxy name="(\w+)"\s+class="vtk(\w+)"', text)[-1]
        classes = [cls, *chains.get(cls, [])]
        own = proxy_rows(table, proxy, cls, chains.get(cls, []))
        find = {row.name: row for row in own}.__getitem__
        opened, own = panel_order(own)
        made = "".join(own_xml(row, classes, find) if row.kind == "own" else property_xml(row, find)
                       for row in own)
        groups, hints = {}, {}
        for row in own:
            name = f'        <Property name="{row.name}"/>\n'
            if row["function"]:
                label = row["group"] + '" panel_widget="InteractiveBox'
                name = name.replace("/>", f' function="{row["function"]}"/>')
                groups[label] = groups.get(label, "") + name
                hints[label] = f"<Hints>{condition(row['shown'], find)}</Hints>\n"
            elif row["panel"] == "table":
                label = 'Surfaces" panel_widget="SurfaceTable'
                groups[label] = groups.get(label, "") + name
            elif row["group"] not in opened and row.has_widget:
                groups[row["group"]] = groups.get(row["group"], "") + name
        grouped = "".join(f'      <PropertyGroup label="{label}">\n{names}{hints.get(label, "")}'
                          "      </PropertyGroup>\n" for label, names in groups.items())
        text = text.replace("@Properties@", made.rstrip("\n"))
        text = text.replace("@Groups@", grouped.rstrip("\n"))
        fold = '<Hints><PropertyWidgetDecorator type="Fold" title="{0}"/></Hints>'
        text = re.sub(r'(?s)(<PropertyGroup label="([^"]+)">.*?)( *</PropertyGroup>)',
                      lambda m: f"{m[1]}        {fold.format(m[2])}\n{m[3]}", text)
        text = re.sub(r"@Override (\w+)@\n",
                      lambda m: property_xml(find(m[1]), find, ' override="1"'), text)
        write(folder / template.name, text)


# ------------------------------------------------------------------------------ command line


PROGRAM_CLASSES = ("DisplacementAlgorithm", "MorphMesh", "MorphAlgorithm", "FEMWarpMorph",
                   "LBWarpMorph", "WeightedResidualMorph", "SimplexNaturalNeighborMorph",
                   "RadialBasisMorph", "SmoothingMorph", "InversionFreeMorph", "MorphShapes")


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def implied(row):
    """What an option sets, too: that on which the panel shows it."""
    if not row["shown"] or "|" in row["shown"]:
        return []
    pairs = [[p.strip() for p in part.split(":")] for part in row["shown"].split("&")]
    return [(name, value) for name, value in pairs if "/" not in value]


def setter(row, cls):
    value = {"number": "value.numbers[0]", "numbers": "value.numbers.data()",
             "integer": "int(value.numbers[0])", "choice": "int(value.numbers[0])",
             "flag": "value.numbers[0] != 0"}.get(row.kind, "value.text.c_str()")
    call = f"Set{row.name}({value})"
    if row.kind == "integers":
        call = f"Set{row.name}({', '.join(f'int(value.numbers[{i}])' for i in range(row.count))})"
    elif row.kind in LISTS:
        call = f"Add{row.name[:-1]}({value})"
    return f"on<vtk{cls}>(filter, [&](auto* one) {{ one->{call}; }})"


def make_options(path):
    table = read()
    lines = []
    for name in table.sections():
        classes = [cls for cls in PROGRAM_CLASSES if cls in table[name]["filters"].split()]
        row = Row(name, table[name], classes[:1])
        if not classes or row.kind == "own":
            continue
        low, high = row.range
        count = row.count if row.kind in ("number", "numbers", "integer", "integers") else 0
        words = ", ".join(quoted(value) for value in row.values)
        defaults = ", ".join(row.default.split()) if count else ""
        pairs = ", ".join(f"{{ {quoted(a)}, {quoted(b)} }}" for a, b in implied(row))
        kind = {"numbers": "number", "integers": "integer", "array": "text",
                **dict.fromkeys(LISTS, "names")}.get(row.kind, row.kind).capitalize()
        text = quoted(" ".join(row.paragraphs[0].split()))
        sets = " ||\n               ".join(setter(row, cls) for cls in classes)
        lines.append(
            f"    {{ {quoted(row.option or '')}, {quoted(name)}, {quoted(row['group'])}, "
            f"Property::Kind::{kind}, {count}, {low or '-unlimited'}, {high or 'unlimited'},\n"
            f"      {{ {words} }}, {{ {defaults} }}, {{ {pairs} }},\n      {text},\n"
            f"      [](vtkAlgorithm* filter, const PropertyValue& value)\n"
            f"      {{ return {sets}; }} }},\n")
    repairs = [Row(name, table[name], ["RepairMesh"]) for name in table.sections()
               if "default of RepairMesh" in table[name]]
    includes = "".join(f"#include <vtk{cls}.h>\n" for cls in sorted(PROGRAM_CLASSES))
    write(path, "// Made by cmake/properties.py from Properties.ini.\n"
          '#include "Properties.h"\n\n' + includes + "\n#include <limits>\n\n"
          "namespace morph_mesh\n{\nnamespace\n{\n"
          "constexpr double unlimited = std::numeric_limits<double>::max();\n\n"
          "template <typename Filter, typename Set>\nbool on(vtkAlgorithm* filter, Set set)\n{\n"
          "  auto* one = Filter::SafeDownCast(filter);\n  if (one)\n  {\n    set(one);\n  }\n"
          "  return one != nullptr;\n}\n}\n\nconst std::vector<Property>& properties()\n{\n"
          "  static const std::vector<Property> all = {\n" + "".join(lines) + "  };\n"
          "  return all;\n}\n\nvoid setRepair(vtkMorphMesh* filter)\n{\n" +
          "".join(f"  filter->Set{row.name}({row.default_number});\n" for row in repairs) +
          "}\n}\n")


# ----------------------------------------------------------------------------------- tests


def make_tests(path):
    table = read()
    lines, classes = [], []
    for header in sorted([*MODULE.glob("vtk*.h"), *MODULE.glob("vtk*.h.in")]):
        cls = header.name.split(".")[0]
        text = header.read_text(encoding="utf-8")
        if f"static {cls}* New();" not in text:
            continue
        own = rows(table, [cls[3:], *bases().get(cls[3:], [])])
        classes += [cls] if own else []
        for row in own:
            if row.kind not in ("number", "integer", "flag", "choice"):
                continue
            low, high = row.range
            if row.kind in ("flag", "choice"):
                low, high = "0", "1" if row.kind == "flag" else str(len(row.values) - 1)
            elif row.kind == "integer":
                low, high = integer_bounds(row)
            value = {"number": "value", "flag": "value != 0"}.get(row.kind, "int(value)")
            # A choice may have fewer values in a class than its superclass accepts.
            most = high if row.kind != "choice" else str(
                len(Row(row.name, table[row.name], []).values) - 1
                if cls[3:] not in table[row.name]["filters"].split() else high)
            lines.append(
                f'  {{ "{cls}", "{row.name}", Kind::{row.kind.capitalize()}, {low or "-Any"}, '
                f"{most or 'Any'}, {row.default_number}, make<{cls}>,\n"
                f"    [](vtkObject* o, double value) "
                f"{{ {cls}::SafeDownCast(o)->Set{row.name}({value}); }},\n"
                f"    [](vtkObject* o) "
                f"{{ return double({cls}::SafeDownCast(o)->Get{row.name}()); }} }},\n")
    includes = "".join(f"#include <{cls}.h>\n" for cls in classes)
    write(path, "// Made by cmake/properties.py from Properties.ini.\n#pragma once\n\n" + includes +
          """
#include <vtkSmartPointer.h>

#include <limits>
#include <vector>

/// The properties of all filters that are one number.
namespace property_rows
{
constexpr double Any = std::numeric_limits<double>::max();

enum class Kind
{
  Number,
  Integer,
  Flag,
  Choice
};

struct Row
{
  const char* filter;
  const char* name;
  Kind kind;
  double least, most, usual;
  vtkSmartPointer<vtkAlgorithm> (*make)();
  void (*set)(vtkObject*, double);
  double (*get)(vtkObject*);
};

template <typename Filter>
vtkSmartPointer<vtkAlgorithm> make()
{
  return vtkSmartPointer<Filter>::New();
}

inline const std::vector<Row> Rows = {
""" + "".join(lines) + "};\n}\n")
    make_result_tests(path.with_name("ResultRows.h"))


def make_result_tests(path):
    lines = [f'  {{ "{cls}", "{name}", "{kind}", "{none}", "{field}", [](vtkObject* o)\n'
             f"    {{ return vtkVariant({cls}::SafeDownCast(o)->Get{name}()); }} }},\n"
             for cls, name, kind, none, field, _ in results()]
    includes = "".join(f"#include <{cls}.h>\n" for cls in dict.fromkeys(
        line.split('"')[1] for line in lines))
    write(path, "// Made by cmake/properties.py from Results.txt.\n#pragma once\n\n" + includes +
          """
#include <vtkVariant.h>

#include <string>
#include <vector>

/// The results of all filters; Results.txt explains the columns.
namespace result_rows
{
struct Row
{
  std::string Filter, Name, Kind, None, Field;
  vtkVariant (*Get)(vtkObject*);
  bool IsField() const { return this->Field != "-"; }
  bool IsAlways() const { return this->Field.back() == '*'; }
  int Place() const { return std::stoi(this->Field); }
};

inline const std::vector<Row> Rows = {
""" + "".join(lines) + "};\n}\n")


# ----------------------------------------------------------------------------------- pages


def accepted(row):
    low, high = row.range
    kind = {"number": "number", "numbers": f"{row.count} numbers", "integer": "whole number",
            "integers": f"{row.count} whole numbers", "flag": "on or off", "text": "text",
            "array": "array", **dict.fromkeys(LISTS, "names")}.get(row.kind, "")
    if row.kind == "choice":
        return ", ".join(row.values)
    if low or high:
        kind += f" from {low or 'any'}" + (f" to {high}" if high else "")
    return kind + (f" ({row['unit']})" if row["unit"] else "")


def make_pages(folder):
    table = read()
    chains = bases()
    for template in sorted((PROJECT / "Plugin").glob("*.xml.in")):
        text = template.read_text(encoding="utf-8")
        proxy, cls = re.findall(r'<\w*SourceProxy name="(\w+)"\s+class="vtk(\w+)"', text)[-1]
        label = re.findall(r'\blabel="([^"]+)"', text[text.index(f'name="{proxy}"'):])[0]
        page = [f"# {label}", "", f"The properties of *{label}* (`{proxy}` in Python, "
                f"`vtk{cls}` in C++), in the order of its panel."]
        group = None
        for row in panel_order(proxy_rows(table, proxy, cls, chains.get(cls, [])))[1]:
            if row.kind == "own" or row["panel"] == "never":
                continue
            if row["group"] != group:
                group = row["group"]
                page += ["", f"## {group}"] if group else []
            default = {"flag": "on" if row.default == "1" else "off"}.get(row.kind, row.default)
            option = f"; `morph-mesh {row.option}`" if row.option else ""
            page += ["", f"### {row.name}", "",
                     f"{accepted(row)}; default {default or 'none'}{option}"]
            page += [line for paragraph in row.paragraphs
                     for line in ["", textwrap.dedent(paragraph).strip()]]
        write(folder / f"{proxy}.md", "\n".join(page) + "\n")


# ---------------------------------------------------------------------------- Python, NumPy


#: The methods of the package meshmorphing, and the beginnings of their filters' names.
METHODS = {"FEMWARP": "FEMWarp", "LBWARP": "LBWarp", "WeightedResidual": "WeightedResidual",
           "SimplexLinear": "SimplexLinear", "SimplexNaturalNeighbor": "SimplexNaturalNeighbor",
           "RadialBasis": "RadialBasis", "Smoothing": "Smoothing",
           "InversionFree": "InversionFree"}


def option_of(row):
    """Its name in Python, type, default, and what Method checks: kind, least or choices, most."""
    name = row.words.lower().replace(" ", "_")
    most = (2**31 - 1) if row.kind == "integer" else float("inf")
    low, high = (v or f'float("{one}")' for v, one in zip(row.range, (-most, most)))
    if row.kind == "choice":
        return name, "str", repr(row.default), f'("choice", {tuple(row.values)}, None)'
    if row.kind == "array":
        return name, "Optional[ArrayLike]", "None", '("array", None, None)'
    return name, {"number": "float", "integer": "int"}[row.kind], row.default, (
        f'("{row.kind}", {low}, {high})')


def make_python(path):
    table = read()
    made = ["# Made by cmake/properties.py from Properties.ini.\n"
            '"""The methods and their options."""',
            "from typing import Optional\n\nfrom numpy.typing import ArrayLike\n\n"
            "from ._arrays import Method\n"]
    for name, stem in METHODS.items():
        cls = f"{stem}Morph"
        header = next(MODULE.glob(f"vtk{cls}.h*")).read_text(encoding="utf-8")
        brief = re.search(r"@brief +(.*)", header)[1]
        own = [(row, *option_of(row)) for row in rows(table, [cls])]
        about = "\n".join(textwrap.fill(
            f"{option}: {accepted(row)}. " + " ".join(row.paragraphs[0].split()), 96,
            initial_indent="    ", subsequent_indent="        ") for row, option, *_ in own)
        made.append(f'\nclass {name}(Method):\n    """{brief[0].upper()}{brief[1:]}.\n' +
                    (f"\n{about}\n" if own else "") + '    """\n')
        if own:
            checks = "".join(f"        {option!r}: {check},\n" for _, option, _, _, check in own)
            arguments = ",\n                 ".join(
                f"{option}: {kind} = {default}" for _, option, kind, default, _ in own)
            passed = ", ".join(f"{option}={option}" for _, option, *_ in own)
            made.append(f"    _OPTIONS = {{\n{checks}    }}\n\n"
                        f"    def __init__(self, *, {arguments}) -> None:\n"
                        f"        super().__init__({passed})\n")
    write(path, "\n".join(made))


MAKERS = {"cxx": make_cxx, "xml": make_xml, "options": make_options, "tests": make_tests,
          "pages": make_pages, "python": make_python}

if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in MAKERS:
        raise SystemExit(__doc__)
    MAKERS[sys.argv[1]](pathlib.Path(sys.argv[2]))
