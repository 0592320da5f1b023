#!/usr/bin/env python3
"""Holds the source tree against the house rules that no compiler knows.

    test/house/check_tree.py [ROOT]

Prints one line for each broken rule, "file:line: what is wrong; what to do", and exits with 1 if
there is any. The rules themselves are explained in CONTRIBUTING.md and docs/architecture.md.
"""

import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

# From the bottom up. An include points to a lower line, never sideways, never up.
LAYERS = [
    ["base"],
    ["geometry", "temporal", "relay", "actions"],
    ["robot", "knowledge"],
    ["world", "planning"],
    ["physics", "navigation", "manipulation", "perception", "execution", "translation",
     "localisation"],
    ["sensing", "mapping"],
    ["simulation", "skills"],
    ["control", "imagination"],
    ["sim_robot"],
    ["loop"],
    ["reports"],
    ["cli", "python", "ros"],
    ["nodes"],
]
RANK = {layer: rank for rank, line in enumerate(LAYERS) for layer in line}
LAYERS_WITH_ROS = {"ros", "nodes"}

# Who publishes ground_truth/..., who compares with it, and who keeps what load went through.
MAY_NAME_TRUTH = ("src/nodes/sim_worker/", "config/topple_monitor.yaml")

CODE_FOLDERS = ["include/hires", "src", "test", "benchmark", "lab"]
TEXT_FOLDERS = [".ci", "action", "benchmark", "cmake", "config", "docs", "examples", "include",
                "lab", "launch", "msg",
                "scripts", "src", "srv", "test", "urdf", "worlds"]
# Given as they are: meshes, maps, and data that tests read.
NOT_OUR_TEXT = re.compile(r"(^|/)test/data/|\.(pgm|png|jpg|gif|stl|dae|obj|bag|db|svg)$", re.IGNORECASE)

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
ROS_HEADER = re.compile(
    r"^(ros|tf2?|tf2_[a-z_]+|actionlib|rosbag|rosgraph_msgs|roslib|topic_tools|message_filters|"
    r"diagnostic_updater|dynamic_reconfigure|xmlrpcpp|[a-z_0-9]+_msgs|[a-z_]+_srvs)/")
GENERATED_MESSAGE = re.compile(r"^hires/[^/]+\.h$")


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8", errors="surrogateescape",
              newline="") as file:
        return file.read()


def files_below(root, folder):
    """Paths relative to root, sorted, so that complaints come in one order everywhere."""
    found = []
    for where, folders, names in os.walk(os.path.join(root, folder)):
        folders[:] = sorted(name for name in folders if name != "__pycache__")
        found += [os.path.relpath(os.path.join(where, name), root) for name in names]
    return sorted(found)


def layer_of(path):
    """The layer a file of code belongs to, and None for what stands outside of the layers."""
    parts = path.split("/")
    if parts[:2] == ["include", "hires"]:
        parts = parts[1:]
    return parts[1] if len(parts) > 2 and parts[1] in RANK else None


def includes_of(root, path):
    """(line number, header) for each include."""
    for number, line in enumerate(read(root, path).splitlines(), start=1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def included_layer(header):
    parts = header.split("/")
    return parts[1] if parts[0] == "hires" and len(parts) > 2 else None


def layer_beside(root, header):
    """The layer that keeps this header beside its sources, if it is named by its path from src/."""
    layer = header.split("/")[0]
    is_there = "/" in header and os.path.exists(os.path.join(root, "src", header))
    return layer if layer in RANK and is_there else None


def may_include(path, layer, other):
    if RANK[other] < RANK[layer] or other == layer:
        return True
    # Tests and benchmarks may join layers of one line, which programs join further up, and show what they
    # found.
    return path.split("/")[0] in ("test", "benchmark") and (RANK[other] == RANK[layer] or other == "reports")


def code_files(root):
    return [path for folder in CODE_FOLDERS for path in files_below(root, folder)
            if path.endswith((".h", ".cpp"))]


def example_files(root):
    return [path for path in files_below(root, "examples") if path.endswith((".h", ".cpp"))]


def check_includes(root):
    for path in code_files(root):
        layer = layer_of(path)
        if layer is None:
            continue
        for number, header in includes_of(root, path):
            yield from check_include(root, path, number, layer, header)


def check_include(root, path, number, layer, header):
    place = f"{path}:{number}"
    other = included_layer(header) or layer_beside(root, header)
    if other is not None and other not in RANK:
        yield f"{place}: layer '{other}' of {header} is unknown; add it to LAYERS in test/house"
    elif other is not None and not may_include(path, layer, other):
        way = "sideways" if RANK[other] == RANK[layer] else "up"
        yield (f"{place}: layer '{layer}' includes {header}, an arrow {way}; move what both need "
               "to a lower layer, or hand it in from above")
    if layer not in LAYERS_WITH_ROS and (
            ROS_HEADER.match(header) or GENERATED_MESSAGE.match(header)):
        yield (f"{place}: layer '{layer}' includes {header}, but only 'ros' and 'nodes' know ROS; "
               "convert in the layer 'ros'")


NOT_INSTALLED = ("include/hires/ros/",)  # see hides_ros


def check_installed_headers(root):
    """What other packages include must find what it includes; nor may they name what stands in src."""
    installed = [path for path in code_files(root)
                 if path.startswith("include/") and not path.startswith(NOT_INSTALLED)]
    for path in installed + example_files(root):
        for number, header in includes_of(root, path):
            if layer_beside(root, header):
                yield (f"{path}:{number}: is for others, but includes {header}, which is not installed; "
                       f"move that to include/hires/{header.split('/')[0]}, or this beside its source")


NAMES_THE_LAB = re.compile(r"\bhires_lab\b|\blab/|\bHIRES_LAB\b")


def check_lab_apart(root):
    """The lab judges the product, which does not know it: not by an include, nor by what it links."""
    for path in code_files(root):
        for number, header in includes_of(root, path) if path.startswith(("include/", "src/")) else ():
            if header.startswith("lab/"):
                yield (f"{path}:{number}: includes {header}, but nothing in src/ sees the lab; move what "
                       "both need into src/")
    builds = [path for path in files_below(root, "src") if os.path.basename(path) == "CMakeLists.txt"]
    for path in builds + [path for path in ("scripts/demo",) if os.path.exists(os.path.join(root, path))]:
        for number, line in enumerate(re.sub(r"#.*", "", read(root, path)).splitlines(), start=1):
            if NAMES_THE_LAB.search(line):
                yield f"{path}:{number}: names the lab, which builds upon the product and not the reverse"


def hides_ros(path):
    """Whether a header beside its source would be found where someone means one of ROS: <ros/names.h>
    is looked for in src, too."""
    return path.startswith("src/") and path.endswith(".h") and bool(ROS_HEADER.match(path[len("src/"):]))


def check_hidden_headers(root):
    for path in files_below(root, "src"):
        if hides_ros(path):
            yield (f"{path}:1: would be taken for the header <{path[len('src/'):]}> of ROS; put it into "
                   f"include/hires/{layer_of(path)}")


HEAVY_HEADER = {"nlohmann/json.hpp": "nlohmann/json_fwd.hpp"}


def check_light_headers(root):
    """What others include does not make them read what only sources need."""
    for path in files_below(root, "include/hires"):
        for number, header in includes_of(root, path):
            if header in HEAVY_HEADER:
                yield (f"{path}:{number}: includes {header}, which all who include it would read; say "
                       f"{HEAVY_HEADER[header]} here and include the other one in sources")


def check_public_headers(root):
    """What stands in include/hires is included by others, itself or through another such header."""
    users = {}
    for path in code_files(root) + example_files(root):
        for _, header in includes_of(root, path):
            users.setdefault(f"include/{header}", set()).add(path)
    headers = [path for path in files_below(root, "include/hires") if path.endswith(".h")]
    used = {path for path in headers
            if any(layer_of(user) != layer_of(path) for user in users.get(path, ()))}
    grown = True
    while grown:
        more = {path for path in headers if path not in used and users.get(path, set()) & used}
        used |= more
        grown = bool(more)
    for path in headers:
        may_move = not hides_ros(f"src/{layer_of(path)}/{os.path.basename(path)}")
        if path not in used and may_move:
            yield (f"{path}:1: no other layer, node or example includes it; keep it beside its "
                   f"source in src/{layer_of(path)}")


LIBRARY = re.compile(r"\bhires_(layer|room|node)\(([^()]*)\)")


def declared_dependencies(root):
    """{library: layers and rooms that its DEPENDS names}. A library is a layer, "layer/room" or
    "nodes/node"."""
    declared = {}
    for layer in RANK:
        path = f"src/{layer}/CMakeLists.txt"
        if not os.path.exists(os.path.join(root, path)):
            continue
        for kind, arguments in LIBRARY.findall(re.sub(r"#.*", "", read(root, path))):
            words = arguments.split()
            name = {"layer": words[0], "room": "/".join(words[:2]), "node": f"nodes/{words[0]}"}[kind]
            after = words[words.index("DEPENDS") + 1:] if "DEPENDS" in words else []
            ends = [i for i, word in enumerate(after) if re.fullmatch("[A-Z_]{3,}", word)]
            declared[name] = after[:ends[0]] if ends else after
    return declared


class Libraries:
    """Which library each file of include and src is part of. A room is part of its layer if that depends on it."""

    def __init__(self, root):
        self.depends = declared_dependencies(root)
        self.of_source = {}  # (layer, name of a source without its end): its library
        for path in files_below(root, "src"):
            if path.endswith(".cpp") and layer_of(path):
                stem = os.path.basename(path)[:-len(".cpp")]
                self.of_source[layer_of(path), stem] = self.by_folder(path)

    def by_folder(self, path):
        layer, parts = layer_of(path), path.split("/")
        below = parts[3:] if parts[0] == "include" else parts[2:]
        room = f"{layer}/{below[0]}" if len(below) > 1 else None
        return room if room in self.depends else layer

    def of(self, path):
        """Of a header that stands with others of its layer, where its source is."""
        library = self.by_folder(path)
        if "/" in library or not path.startswith("include/"):
            return library
        return self.of_source.get((library, os.path.splitext(os.path.basename(path))[0]), library)

    def has_source(self, path):
        return (layer_of(path), os.path.splitext(os.path.basename(path))[0]) in self.of_source

    def bringing(self, path, library):
        """Those among the dependencies of `library` that bring what this header declares."""
        owner, layer = self.of(path), layer_of(path)
        declared = self.depends[library]
        if owner in declared:
            return [owner]
        is_part = owner == layer or owner in self.depends.get(layer, [])
        if layer in declared and (is_part or not self.has_source(path)):
            return [layer]
        # A header without a source needs no library, only one that knows the layer.
        return [] if self.has_source(path) else [d for d in declared if d.startswith(layer + "/")]


def place_of(library):
    return f"src/{library.split('/')[0]}/CMakeLists.txt"


def check_dependency(library, lower):
    layer, other = library.split("/")[0], lower.split("/")[0]
    is_own_room = other == layer and "/" in lower and lower != library and layer != "nodes"
    if other not in RANK or (RANK[other] >= RANK[layer] and not is_own_room):
        kind = "layer" if library == layer else "room" if layer != "nodes" else "node"
        yield (f"{place_of(library)}: {kind} '{library}' DEPENDS on '{lower}', which is "
               "no lower layer; move what both need down")


def check_dependencies(root):
    """CMake says what the includes say: no layer or room more, none less, none that points up."""
    libraries = Libraries(root)
    used = {library: set() for library in libraries.depends}
    for library, lower_ones in libraries.depends.items():
        for lower in lower_ones:
            yield from check_dependency(library, lower)
    for path in code_files(root):
        if layer_of(path) is None or path.startswith(("test/", "benchmark/")):
            continue
        library = libraries.of(path)
        if library in used:
            yield from check_use(root, path, library, libraries, used[library])
    for library, lower_ones in libraries.depends.items():
        for lower in lower_ones:
            is_lower = RANK.get(lower.split("/")[0], RANK["nodes"]) < RANK[library.split("/")[0]]
            if is_lower and lower not in used[library]:
                yield (f"{place_of(library)}: '{library}' DEPENDS on '{lower}', of which it "
                       "includes nothing; take it out")


def check_use(root, path, library, libraries, used):
    layer = layer_of(path)
    for number, header in includes_of(root, path):
        found = own_file(root, path, header)
        other = layer_of(found) if found else included_layer(header)
        if other not in RANK or RANK[other] > RANK[layer] or (RANK[other] == RANK[layer] and other != layer):
            continue
        target = found or f"include/{header}"
        if libraries.of(target) == library or other == layer and not libraries.has_source(target):
            continue
        bringing = libraries.bringing(target, library)
        if not bringing:
            owner = libraries.of(target)
            yield (f"{path}:{number}: '{library}' includes {header} without depending on "
                   f"'{owner}'; add it to DEPENDS in {place_of(library)}")
        used.update(bringing)


def check_circles(root):
    """Rooms of one layer may use each other, one way."""
    depends = declared_dependencies(root)
    for first in sorted(depends):
        layer, seen, todo = first.split("/")[0], set(), [first]
        while todo:
            rooms = [lower for lower in depends.get(todo.pop(), []) if lower.startswith(layer + "/")]
            todo += [room for room in rooms if room not in seen]
            seen.update(rooms)
        if first in seen:
            yield f"{place_of(first)}: '{first}' DEPENDS on itself through others; move what they share down"


def own_headers(root, path):
    """How a source may name its own header, as far as it is there: beside it, or for others."""
    beside = path[len("src/"):-len(".cpp")] + ".h"
    stem = os.path.basename(beside)
    names = [beside, stem] if os.path.exists(os.path.join(root, "src", beside)) else []
    # Rooms are a layer's own affair, but where headers stand in rooms, too.
    for for_others in (f"hires/{beside}", f"hires/{layer_of(path)}/{stem}"):
        if os.path.exists(os.path.join(root, "include", for_others)):
            names.append(for_others)
    return names


# Nothing but names; STYLE of the project keeps those of topics where topics are.
NAMES_OF_TOPICS = {"ros/names/robot_topics", "ros/names/topic_names"}
# What these do is to ask ROS, though no type of it stands in their headers: who calls them needs it.
ASKS_ROS = {"ros/robot/load_robot_names", "ros/node/private_params"}


def unit_of(path):
    """What header and source of one name have in common: "ros/node/run_node"."""
    below = path[len("include/hires/"):] if path.startswith("include/hires/") else path[len("src/"):]
    return os.path.splitext(below)[0]


def units_of(root):
    """{unit: its files} of include and src"""
    units = {}
    for path in code_files(root):
        if path.startswith(("include/hires/", "src/")):
            units.setdefault(unit_of(path), []).append(path)
    return units


def own_file(root, path, header):
    """The file of ours that an include of `path` means, or None."""
    for candidate in (f"include/{header}", f"src/{header}",
                      os.path.normpath(os.path.join(os.path.dirname(path), header))):
        if os.path.exists(os.path.join(root, candidate)):
            return candidate
    return None


def sees_ros(root, paths):
    """Whether these files include ROS, generated messages or ASKS_ROS, themselves or through headers.
    What the sources behind those headers include is their own affair."""
    seen, todo = set(paths), list(paths)
    while todo:
        path = todo.pop()
        for _, header in includes_of(root, path):
            found = own_file(root, path, header)
            if found is None and (ROS_HEADER.match(header) or GENERATED_MESSAGE.match(header)):
                return True
            if found and unit_of(found) in ASKS_ROS:
                return True
            if found and found not in seen:
                seen.add(found)
                todo.append(found)
    return False


def check_units_with_ros(root):
    """What knows no ROS is of use below, and is tested there without ROS."""
    units = units_of(root)
    for unit, paths in sorted(units.items()):
        is_main = unit.startswith("nodes/") and unit.endswith("_main")  # which only calls what does
        if unit.split("/")[0] not in LAYERS_WITH_ROS or unit in NAMES_OF_TOPICS | ASKS_ROS or is_main:
            continue
        if not sees_ros(root, paths):
            yield (f"{paths[0]}:1: sees no ROS, not even through headers; move it down to the layer that "
                   "it is about")


def check_nodes_apart(root):
    """Nodes meet on topics; what two of them need is shared further down."""
    for path in code_files(root):
        node = path.split("/")[2] if path.startswith("src/nodes/") else None
        for number, header in includes_of(root, path) if node else ():
            parts = (own_file(root, path, header) or "").split("/")
            if parts[:2] == ["src", "nodes"] and parts[2] != node:
                yield (f"{path}:{number}: node '{node}' includes {header} of another node; move what both "
                       "need to 'ros' or below")


MOST_UNITS = 25


def check_rooms(root):
    """A folder fits in a glance; a header and its source in one folder are one unit."""
    folders = {}
    for path in code_files(root):
        if path.startswith(("include/hires/", "src/", "lab/src/")):
            folder, name = os.path.split(path)
            folders.setdefault(folder, set()).add(os.path.splitext(name)[0])
    for folder, units in sorted(folders.items()):
        if len(units) > MOST_UNITS:
            yield (f"{folder}: has {len(units)} units (pairs of header and source), wanted at most "
                   f"{MOST_UNITS}; make rooms by concept")


MOST_LINES = 60
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)\'',
                     re.DOTALL)
NO_FUNCTION = re.compile(r"\s*(?:template\s*<.*>\s*)?(?:inline )?(?:namespace|class|struct|union|enum|extern)\b"
                         r"|[^(]*$|.*[=,(]\s*$", re.DOTALL)


GOES_ON = re.compile(r"(?!\s*#).*[^\s;:{}]\s*$")  # a statement that does not end with the line


def indent_of(line):
    return len(line) - len(line.lstrip())


def functions_in(text):
    """(line, number of lines) for each definition with a body, as `scripts/format` writes them: it ends
    where a brace stands as far to the left as its first line."""
    code = NO_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)
    lines, opened = code.split("\n"), []
    for last, line in enumerate(lines):
        for match in re.finditer(r"[{}]", line):
            if match.group() == "{":
                opened.append((last, match.start()))
            elif opened:
                brace, column = opened.pop()
                first = brace
                while first > 0 and (indent_of(lines[first]) > indent_of(line) or
                                     GOES_ON.match(lines[first - 1])):
                    first -= 1
                head = "\n".join(lines[first:brace] + [lines[brace][:column]])
                if brace < last and match.start() == indent_of(line) and not NO_FUNCTION.match(head):
                    yield first + 1, last - first + 1


def check_functions(root):
    """A function fits in a glance."""
    for path in code_files(root):
        if not path.startswith(("include/hires/", "src/")):
            continue
        for line, length in functions_in(read(root, path)):
            if length > MOST_LINES:
                yield (f"{path}:{line}: is {length} lines long, wanted at most {MOST_LINES}; give its parts "
                       "names")


def check_own_header(root, path):
    """A source includes its header first, which proves that the header needs nothing else. One
    without a header of its name implements a part of another of its layer, so it includes that."""
    includes = list(includes_of(root, path))
    number, first = includes[0] if includes else (1, "nothing")
    own, layer = own_headers(root, path), layer_of(path)
    has_part = any(layer in (included_layer(header), layer_beside(root, header)) or
                   os.path.exists(os.path.join(root, os.path.dirname(path), header))
                   for _, header in includes)
    if own and first not in own:
        yield f"{path}:{number}: includes {first} first; start with its own header {own[0]}"
    if not own and not has_part:
        stem = os.path.basename(path)[:-len(".cpp")]
        yield (f"{path}:1: has no header; write {path[:-len('.cpp')]}.h, or "
               f"include/hires/{layer}/{stem}.h if others need it, or include the header of its "
               "layer that it implements")


def check_headers(root):
    """Every source has its header (programs excepted), every header guards itself."""
    for path in code_files(root):
        if path.startswith("src/") and path.endswith(".cpp") and layer_of(path) != "nodes":
            yield from check_own_header(root, path)
        if path.endswith(".h") and "#pragma once" not in read(root, path):
            yield f"{path}:1: has no '#pragma once'; add it"


def check_whitespace(root):
    paths = [path for folder in TEXT_FOLDERS for path in files_below(root, folder)]
    paths += [name for name in sorted(os.listdir(root)) if os.path.isfile(os.path.join(root, name))]
    for path in paths:
        if NOT_OUR_TEXT.search(path):
            continue
        text = read(root, path)
        if "\0" not in text:
            yield from check_whitespace_of(path, text)


def check_whitespace_of(path, text):
    for number, line in enumerate(text.split("\n"), start=1):
        if "\t" in line:
            yield f"{path}:{number}: has a tab; use spaces"
        if line != line.rstrip():
            yield f"{path}:{number}: ends in white space; remove it"
    if text and not text.endswith("\n"):
        yield f"{path}:{text.count(chr(10)) + 1}: does not end with a line break; add one"


def rosdep_keys_of_packages(root):
    """{rosdep key: line number} from the brackets in packages.txt, and complaints about the file."""
    keys, packages, complaints = {}, {}, []
    for number, line in enumerate(read(root, "scripts/packages.txt").splitlines(), start=1):
        package, _, comment = line.partition("#")
        package, place = package.strip(), f"scripts/packages.txt:{number}"
        if not package:
            continue
        if not re.fullmatch(r"[a-z0-9][a-z0-9.+-]+", package):
            complaints.append(f"{place}: '{package}' is no package name; write one package a line")
        if not comment.strip():
            complaints.append(f"{place}: {package} comes without a reason; say why behind a '#'")
        if package in packages:
            complaints.append(f"{place}: {package} stands in line {packages[package]} already")
        packages[package] = number
        for brackets in re.findall(r"\[([^\]]*)\]", comment):
            keys.update({key: number for key in brackets.split()})
    return keys, complaints


def check_packages(root):
    keys, complaints = rosdep_keys_of_packages(root)
    yield from complaints
    package = ElementTree.parse(os.path.join(root, "package.xml")).getroot()
    wanted = {element.text.strip() for element in package if element.tag.endswith("depend")}
    for key in sorted(wanted - keys.keys()):
        yield (f"package.xml: {key} has no Debian package; name it in brackets behind its package "
               "in scripts/packages.txt")
    for key in sorted(keys.keys() - wanted):
        yield (f"scripts/packages.txt:{keys[key]}: package.xml does not name [{key}]; add a "
               "<depend> or drop it here")


LOOKS_FOR = re.compile(r"^\s*(?:find_package\(([\w-]+)|pkg_check_modules\([^)]*?([\w-]+)\))", re.MULTILINE)
OF_ROS_AND_THE_COMPILER = {"catkin", "hires", "Threads"}


def check_libraries(root):
    """What CMake looks for is in the list of packages, and nothing else is said to be looked for."""
    told, wanted = {}, {}
    for number, line in enumerate(read(root, "scripts/packages.txt").splitlines(), start=1):
        told.update({name: number for name in re.findall(r"<([\w-]+)>", line.partition("#")[2])
                     if line.partition("#")[0].strip()})
    cmake_files = ["CMakeLists.txt"] if os.path.exists(os.path.join(root, "CMakeLists.txt")) else []
    for folder in ("cmake", "src", "test", "benchmark"):
        cmake_files += [path for path in files_below(root, folder)
                        if path.endswith(("CMakeLists.txt", ".cmake"))]
    for path in cmake_files:
        for match in LOOKS_FOR.finditer(read(root, path)):
            name = match.group(1) or match.group(2)
            if name not in OF_ROS_AND_THE_COMPILER:
                wanted.setdefault(name, path)
    for name in sorted(wanted.keys() - told.keys()):
        yield (f"{wanted[name]}: looks for {name}, which no package of scripts/packages.txt is said to bring; "
               f"write <{name}> behind the one that does")
    for name in sorted(told.keys() - wanted.keys()):
        yield (f"scripts/packages.txt:{told[name]}: <{name}> is what no CMakeLists.txt looks for; take it out, "
               "and the package if nothing else needs it")


def check_catkin_components(root):
    """What CMake asks catkin for must stand in package.xml."""
    path = "cmake/HiresRos.cmake"
    if not os.path.exists(os.path.join(root, path)):
        return
    match = re.search(r"find_package\(catkin REQUIRED COMPONENTS([^)]*)\)", read(root, path))
    named = {element.text.strip()
             for element in ElementTree.parse(os.path.join(root, "package.xml")).getroot()
             if element.tag.endswith("depend")}
    for component in match.group(1).split() if match else []:
        if component not in named:
            yield f"{path}: asks catkin for {component}, which package.xml does not name; add it"


def check_version(root):
    """One version in all places that tell it."""
    told = {}
    for path, pattern in (("package.xml", r"<version>([^<]+)</version>"),
                          ("CMakeLists.txt", r"project\(hires VERSION (\S+)"),
                          ("CHANGELOG.rst", r"^(\d+\.\d+\.\d+) ")):
        if os.path.exists(os.path.join(root, path)):
            match = re.search(pattern, read(root, path), re.MULTILINE)
            if match:
                told[path] = match.group(1)
    for path, version in sorted(told.items()):
        if version != told.get("package.xml", version):
            yield f"{path}: tells version {version}, package.xml {told['package.xml']}; make them one"


def check_scripts(root):
    for path in files_below(root, "scripts") + files_below(root, ".ci"):
        first = read(root, path).split("\n", 1)[0]
        if first.startswith("#!") and not os.access(os.path.join(root, path), os.X_OK):
            yield f"{path}:1: has '{first}' but cannot be executed; chmod +x"
        if "bash" in first or path.endswith(".sh"):
            syntax = subprocess.run(["bash", "-n", os.path.join(root, path)],
                                    stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                    check=False)
            if syntax.returncode != 0:
                yield f"{path}: bash cannot read it: {syntax.stderr.strip()}"
        elif "python3" in first:
            try:
                compile(read(root, path), path, "exec")
            except SyntaxError as error:
                yield f"{path}:{error.lineno}: python cannot read it: {error.msg}"


FAILURE_TABLE = "src/base/failure.cpp"
# Words that mean something else beside a failure, and where. Elsewhere base::FailureCode says it.
ALSO_MEANS = {
    "imagined_failure": {  # a predicate of the planner
        "src/execution/exclusions.cpp", "src/knowledge/state/state_view_rules.cpp",
        "src/planning/search/operator_applier.cpp", "src/planning/check/step_replay.cpp",
        "src/translation/wanted_state.cpp"},
    "motors_halted": {  # a key of a robot's names, a finding of the doctor
        "src/cli/verbs/doctor/robot_doctor_judge.cpp", "src/control/names/robot_names.cpp"},
    "busy": {"src/loop/achieve.cpp"},  # outcomes of a task, from here on
    "dry_run": {
        "src/loop/achieve.cpp", "src/nodes/execution_monitor/execution_messages.cpp",
        "src/nodes/execution_monitor/execution_monitor_node.cpp", "src/nodes/middle_layer/middle_layer_params.cpp"},
    "preempted": {
        "src/loop/achieve.cpp", "src/execution/step_watch.cpp",
        "src/nodes/execution_monitor/execution_messages.cpp"},
    "unavailable": {  # an outcome of imagination
        "src/loop/achieve.cpp", "src/nodes/execution_monitor/execution_messages.cpp"},
}
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"', re.DOTALL)
FOR_PEOPLE = r"\b[\w.>()\[\]-]*(?:reason|detail|failure|why)_?(?:\(\))?"
TAKES_TEXT_APART = re.compile(
    FOR_PEOPLE + r"\s*\.\s*(?:find|rfind|substr|compare|starts_with|startswith|endswith|split|partition)\("
    r"|" + FOR_PEOPLE + r"\s*(?:[!=]=|\b(?:not )?in\b)\s*\(?[\"'][^\"']"
    r"|[^\"'\s(][\"']\s*[!=]=\s*" + FOR_PEOPLE + r"(?![\w(])"
    r"|\bToString\([^()]*(?:failure|code)(?:\(\))?\)\s*[!=]="
    r"|[!=]=\s*ToString\([^()]*(?:failure|code)(?:\(\))?\)")


def check_failure_codes(root):
    """The message Failure and the table in base carry the same codes under the same numbers."""
    message, table = "msg/Failure.msg", FAILURE_TABLE
    header = "include/hires/base/failure.h"
    if not all(os.path.exists(os.path.join(root, path)) for path in (message, table, header)):
        return
    words = dict(re.findall(r'\{Code::(k\w+), "(\w+)"', read(root, table)))
    numbers = dict(re.findall(r"^\s*(k\w+) = (\d+)", read(root, header), re.MULTILINE))
    wanted = {words[name].upper(): number for name, number in numbers.items() if name in words}
    told = dict(re.findall(r"^uint16 (\w+)=(\d+)", read(root, message), re.MULTILINE))
    told.pop("NONE", None)
    for name in sorted(set(numbers) - set(words) - {"kNone"}):
        yield f"{table}: has no row for {name} of {header}; add one"
    for name in sorted(set(wanted) | set(told)):
        if wanted.get(name) != told.get(name):
            yield (f"{message}: {name} is {told.get(name, 'missing')}, in {header} it is "
                   f"{wanted.get(name, 'missing')}; let both say the same")


def failure_words(root):
    if not os.path.exists(os.path.join(root, FAILURE_TABLE)):
        return set()
    return set(re.findall(r'Code::k\w+,\s*"([a-z_]+)"', read(root, FAILURE_TABLE)))


def code_and_texts(text):
    """The code without comments, and the texts in it: [(offset, text without its quotes)]."""
    texts = [(match.start(), match.group()[1:-1]) for match in COMMENT_OR_TEXT.finditer(text)
             if match.group().startswith('"')]
    code = COMMENT_OR_TEXT.sub(
        lambda match: match.group() if match.group().startswith('"') else
        re.sub(r"[^\n]", " ", match.group()), text)
    return code, texts


def check_failure_texts(root):
    """A failure is a code: its word stands in the table, and nobody compares what is for people."""
    words = failure_words(root)
    for path in code_files(root):
        if not words or path == FAILURE_TABLE or not path.startswith(("include/", "src/")):
            continue
        text = read(root, path)
        code, texts = code_and_texts(text)
        for offset, quoted in texts:
            word = quoted.split(":", 1)[0]
            if word in words and (quoted != word or path not in ALSO_MEANS.get(word, ())):
                yield (f"{path}:{text.count(chr(10), 0, offset) + 1}: has the failure word '{word}' "
                       "as a text; say base::FailureCode, and base::ToString for people")
        for match in TAKES_TEXT_APART.finditer(code):
            yield (f"{path}:{text.count(chr(10), 0, match.start()) + 1}: compares or takes apart "
                   f"'{match.group().strip()}', which is for people; compare codes and subjects")


def check_python_texts(root):
    """As for C++: in scripts and tests, too, a failure is its code. (Tests may look for words that people
    are to read.)"""
    for path in [p for folder in ("examples", "scripts", "test") for p in files_below(root, folder)]:
        if not path.endswith(".py") or path.startswith("test/house/"):
            continue
        for number, line in enumerate(read(root, path).splitlines(), start=1):
            match = TAKES_TEXT_APART.search(line.split("#")[0])
            if match:
                yield (f"{path}:{number}: compares or takes apart '{match.group().strip()}', which is for "
                       "people; compare codes and subjects")


def check_failure_tables(root):
    """What documents say that an action fails with is in the table of failures."""
    words = failure_words(root)
    for path in ["README.md"] + files_below(root, "docs"):
        if not words or not path.endswith(".md") or not os.path.exists(os.path.join(root, path)):
            continue
        column = None
        for number, line in enumerate(read(root, path).splitlines(), start=1):
            cells = line.split("|") if line.startswith("|") else []
            heads = [i for i, cell in enumerate(cells) if cell.strip().startswith("fails with")]
            column = heads[0] if heads else column if cells else None
            if column is None or column >= len(cells):
                continue
            for word in re.findall(r"`([^`:]*)[^`]*`", cells[column]):
                if word not in words:
                    yield (f"{path}:{number}: '{word}' is no failure; take a word of "
                           f"{FAILURE_TABLE}, or add a code there")


TEST_RUN = "test/ros/support/test_run.py"
RUNS_CASES_ITSELF = re.compile(r"\b(?:rosunit\.unitrun|rostest\.(?:rosrun|run|unitrun))\b"
                               r"|^\s*from (?:rosunit|rostest) import .*\b(?:unitrun|rosrun)\b")


def check_rostests(root):
    """rosunit does not say which part of a test failed; what runs the cases for all tests does."""
    for path in [p for folder in ("test", "lab/test", "examples") for p in files_below(root, folder)]:
        if not path.endswith(".py") or path == TEST_RUN or path.startswith("test/house/"):
            continue
        for number, line in enumerate(read(root, path).splitlines(), start=1):
            if RUNS_CASES_ITSELF.search(line):
                yield (f"{path}:{number}: lets rosunit run the cases, which does not tell what fails "
                       f"in a subTest; call run_test of {TEST_RUN}")


def check_test_namespaces(root):
    """Files of tests are compiled together; what each defines for itself must not meet."""
    for path in files_below(root, "test") + files_below(root, "lab/test"):
        layer = "lab" if path.startswith("lab/") else layer_of(path)
        if not path.endswith("_test.cpp") or layer is None:
            continue
        stem = os.path.basename(path)[:-len(".cpp")]
        text = read(root, path)
        own = re.compile(rf"^namespace hires\w*(?:::\w+)*::{stem} {{$", re.MULTILINE)
        if re.search(r"^(namespace|TEST)", text, re.MULTILINE) and not own.search(text):
            yield (f"{path}:1: defines what it needs in a namespace that other files of tests share; "
                   f"write namespace hires::{layer}::{stem}")


def check_instructions(root):
    """What CONTRIBUTING.md tells people to open must be there."""
    path = "CONTRIBUTING.md"
    if not os.path.exists(os.path.join(root, path)):
        return
    named = re.compile(r"`((?:cmake|config|docs|examples|include|lab|launch|scripts|src|test)/[\w./-]+)`")
    for number, line in enumerate(read(root, path).splitlines(), start=1):
        for file in named.findall(line):
            if not os.path.exists(os.path.join(root, file)):
                yield f"{path}:{number}: there is no {file}; name what took its place"


def check_ground_truth(root):
    """What decides must not know what is true: it would prove nothing by being right."""
    for path in [p for folder in ("config", "include", "src", "launch") for p in files_below(root, folder)]:
        if path.startswith(MAY_NAME_TRUTH):
            continue
        for number, line in enumerate(read(root, path).splitlines(), start=1):
            if "ground_truth" in line:
                yield (f"{path}:{number}: names the topic of the truth; only the simulated robot and the "
                       f"command line may, and tests")


CHECKS = [check_includes, check_installed_headers, check_lab_apart, check_public_headers, check_hidden_headers,
          check_light_headers, check_dependencies, check_circles, check_units_with_ros, check_nodes_apart, check_rooms,
          check_functions, check_headers, check_whitespace, check_packages, check_libraries,
          check_catkin_components,
          check_version, check_scripts, check_failure_codes, check_failure_texts, check_python_texts,
          check_failure_tables, check_rostests, check_test_namespaces, check_instructions,
          check_ground_truth]


def complaints_about(root):
    return [complaint for check in CHECKS for complaint in check(root)]


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "../..")
    if not os.path.isdir(os.path.join(root, "src")):
        sys.exit(f"check_tree: {root} has no folder src; name the root of the checkout")
    complaints = complaints_about(root)
    print("\n".join(complaints) if complaints else "check_tree: every house rule is kept")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
