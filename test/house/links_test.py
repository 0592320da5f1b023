#!/usr/bin/env python3
"""Is a node linked with no more than it is about? What must act when all else fails is small.

    test/house/links_test.py NODE_LINKS PROGRAMS

NODE_LINKS is what CMake writes, one line for each node: its name, a colon, the libraries of this package that it
is linked with. PROGRAMS is the folder of the nodes' programs.
"""

import os
import subprocess
import sys
import unittest

# Layers that are none of a node's business. They are libraries, and namespaces in its program.
FOREIGN = {
    "base_guard": ["actions", "evaluation", "execution", "imagination", "knowledge", "localisation", "loop",
                   "manipulation", "perception", "physics", "planning", "simulation", "skills", "temporal",
                   "translation", "world"],
    "execution_monitor": ["evaluation", "localisation", "loop", "manipulation", "navigation",
                          "perception", "physics", "sensing", "simulation", "skills", "translation"],
    "relay": ["geometry", "robot", "world"],
}
# Layers of which a node is linked with single rooms alone.
ONLY_ROOMS = {
    "base_guard": ["control", "navigation", "relay", "sensing"],
    "execution_monitor": ["control", "imagination"],
}


def read_links(path):
    with open(path, encoding="utf-8") as file:
        lines = [line.split(":") for line in file if line.strip()]
    return {node: libraries.split() for node, libraries in lines}


def foreign_libraries(libraries, layers):
    return [library for library in libraries
            if any(library == f"hires_{layer}" or library.startswith(f"hires_{layer}_") for layer in layers)]


def foreign_symbols(program, layers):
    """The first symbol of each of these layers that the program has."""
    listing = subprocess.run(["nm", "--demangle", "--defined-only", program], stdout=subprocess.PIPE, text=True,
                             check=True).stdout.splitlines()
    first = {layer: next((line for line in listing if f"hires::{layer}::" in line), None) for layer in layers}
    return [line for line in first.values() if line]


class LinksTest(unittest.TestCase):
    links, programs = "", ""

    def test_a_node_is_linked_with_no_library_of_a_foreign_layer(self):
        links = read_links(self.links)
        for node, layers in FOREIGN.items():
            with self.subTest(node=node):
                self.assertEqual(foreign_libraries(links[node], layers), [],
                                 "look at DEPENDS in src/nodes/CMakeLists.txt, and at those of what it names")

    def test_a_node_that_needs_a_room_is_not_linked_with_the_whole_layer(self):
        links = read_links(self.links)
        for node, layers in ONLY_ROOMS.items():
            with self.subTest(node=node):
                self.assertEqual([layer for layer in layers if f"hires_{layer}" in links[node]], [])

    def test_a_program_has_no_symbol_of_a_foreign_layer(self):
        for node, layers in FOREIGN.items():
            with self.subTest(node=node):
                program = os.path.join(self.programs, node)
                self.assertTrue(os.path.exists(program), f"{program} is not there; build it")
                self.assertEqual(foreign_symbols(program, layers), [])

    def test_libraries_of_rooms_are_told_from_those_of_other_layers(self):
        libraries = ["hires_base", "hires_robot", "hires_ros_robot", "hires_world", "hires_navigation_guard"]
        self.assertEqual(foreign_libraries(libraries, ["navigation", "world", "sim"]),
                         ["hires_world", "hires_navigation_guard"])


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    LinksTest.programs = sys.argv.pop()
    LinksTest.links = sys.argv.pop()
    unittest.main()
