#!/usr/bin/env python3
"""Does check_tree.py notice what it should? Every rule is broken once, in a tree made for it."""

import os
import tempfile
import unittest

import check_tree

GOOD_TREE = {
    "package.xml": "<package><depend>roscpp</depend><depend>opende</depend></package>\n",
    "scripts/packages.txt": "ros-base-dev  # ROS [roscpp]\nlibode-dev  # physics [opende]\n",
    "scripts/build": "#!/bin/bash\necho built\n",
    "cmake/HiresRos.cmake": "find_package(catkin REQUIRED COMPONENTS\n  roscpp)\n",
    "include/hires/base/rng.h": "#pragma once\n#include <cstdint>\n",
    "src/base/rng.cpp": '#include "hires/base/rng.h"\n',
    "src/base/CMakeLists.txt": "hires_layer(base\n  SOURCES rng.cpp\n  LINK fmt::fmt)\n",
    "include/hires/geometry/pose.h": '#pragma once\n#include "hires/base/rng.h"\n',
    "src/geometry/CMakeLists.txt": "hires_layer(geometry DEPENDS base LINK Eigen3::Eigen)\n",
    "include/hires/robot/model.h": '#pragma once\n#include "hires/geometry/pose.h"\n',
    "src/robot/CMakeLists.txt": "hires_layer(robot\n  DEPENDS geometry)  # and what it needs\n",
    "include/hires/simulation/simulator.h": '#pragma once\n#include "hires/robot/model.h"\n',
    "include/hires/skills/skill.h": '#pragma once\n#include "hires/robot/model.h"\n',
    "include/hires/ros/messages.h":
        '#pragma once\n#include <ros/time.h>\n#include "hires/Fluent.h"\n'
        '#include "hires/skills/skill.h"\n',
    "src/nodes/planner/planner_main.cpp": '#include "hires/ros/messages.h"\n',
    "test/skills/skill_test.cpp":
        '#include "hires/simulation/simulator.h"\n#include "support/fakes.h"\n'
        "namespace hires::skills::skill_test {\n}\n",
    "test/data/given.txt": "tabs\tof others stay \n",
}


class CheckTreeTest(unittest.TestCase):
    def complaints(self, changes):
        """What check_tree says about the good tree with some files changed, added or removed."""
        with tempfile.TemporaryDirectory() as root:
            for path, text in {**GOOD_TREE, **changes}.items():
                if text is None:
                    continue
                os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
                with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                    file.write(text)
                if text.startswith("#!"):
                    os.chmod(os.path.join(root, path), 0o755)
            return check_tree.complaints_about(root)

    def expect_one(self, changes, *words):
        complaints = self.complaints(changes)
        self.assertEqual(len(complaints), 1, complaints)
        for word in words:
            self.assertIn(word, complaints[0])

    def test_a_good_tree_is_left_in_peace(self):
        self.assertEqual(self.complaints({}), [])

    def test_two_versions_are_found(self):
        self.expect_one({"CHANGELOG.rst": "0.0.1 (2000-01-01)\n", "package.xml":
                         GOOD_TREE["package.xml"].replace("<package>",
                                                          "<package><version>0.0.2</version>")},
                        "CHANGELOG.rst", "0.0.1", "0.0.2")

    def test_an_include_that_points_up_is_found(self):
        self.expect_one({"src/base/rng.cpp": '#include "hires/base/rng.h"\n#include "hires/geometry/pose.h"\n'},
                        "src/base/rng.cpp:2", "an arrow up", "lower layer")

    def test_an_include_that_points_sideways_is_found(self):
        self.expect_one(
            {"include/hires/skills/skill.h":
                 '#pragma once\n#include "hires/simulation/simulator.h"\n'},
            "include/hires/skills/skill.h:2", "an arrow sideways")

    def test_a_test_that_includes_a_higher_layer_is_found(self):
        self.expect_one({"test/robot/model_test.cpp": '#include "hires/skills/skill.h"\n'},
                        "test/robot/model_test.cpp:1", "an arrow up")

    def test_an_unknown_layer_is_found(self):
        self.expect_one({"src/nodes/wizard/wizard_main.cpp":
                             '#include <ros/ros.h>\n#include "hires/magic/wand.h"\n'},
                        "'magic'", "LAYERS")

    def test_ros_below_its_layer_is_found(self):
        for header in ("ros/ros.h", "tf2/buffer_core.h", "tf2_ros/buffer.h", "geometry_msgs/Pose.h",
                       "actionlib/server/simple_action_server.h", "std_srvs/Empty.h",
                       "hires/Fluent.h"):
            self.expect_one({"src/base/rng.cpp": f'#include "hires/base/rng.h"\n#include <{header}>\n'},
                            "src/base/rng.cpp:2", header, "know ROS")
        self.expect_one({"src/cli/said.h": "#pragma once\n#include <ros/ros.h>\n"},
                        "src/cli/said.h:2", "'cli'", "know ROS")

    def test_names_that_only_look_like_ros_are_left_in_peace(self):
        self.assertEqual(self.complaints(
            {"src/base/rng.cpp": '#include "hires/base/rng.h"\n'
                                 "#include <rosy.h>\n#include <XmlRpcClient.h>\n"
                                 "// #include <ros/ros.h> would be wrong here\n"}), [])

    def test_a_unit_of_ros_or_nodes_that_sees_no_ros_is_found(self):
        plain = {"include/hires/ros/words.h": '#pragma once\n#include "hires/base/rng.h"\n',
                 "src/ros/words.cpp": '#include "hires/ros/words.h"\n',
                 "src/nodes/planner/said.cpp": '#include <ros/time.h>\n#include "hires/ros/words.h"\n'}
        self.expect_one(plain, "include/hires/ros/words.h:1", "sees no ROS", "move it down")
        self.expect_one({"src/nodes/planner/pool.cpp": "#include <vector>\n"},
                        "src/nodes/planner/pool.cpp:1", "sees no ROS")
        # What the source of another unit includes is that unit's own affair.
        self.expect_one({"src/nodes/planner/watch.h": "#pragma once\n",
                         "src/nodes/planner/watch.cpp": '#include "watch.h"\n#include <ros/time.h>\n',
                         "src/nodes/planner/judge.cpp": '#include "watch.h"\n'},
                        "src/nodes/planner/judge.cpp:1", "sees no ROS")

    def test_a_unit_that_sees_ros_through_others_is_left_in_peace(self):
        self.assertEqual(self.complaints(
            {"include/hires/ros/words.h": '#pragma once\n#include "hires/ros/more_words.h"\n',
             "include/hires/ros/more_words.h": '#pragma once\n#include <hires/Fluent.h>\n',
             "src/nodes/planner/pool.h":
                 '#pragma once\n#include "hires/ros/words.h"\n#include "hires/ros/more_words.h"\n',
             "src/nodes/planner/pool_more.cpp": '#include "pool.h"\n',
             "include/hires/ros/master.h": "#pragma once\n",
             "src/ros/master.cpp": '#include "hires/ros/master.h"\n#include <xmlrpcpp/XmlRpcClient.h>\n',
             "src/nodes/planner/watch.cpp":
                 '#include "hires/ros/master.h"\n#include "hires/ros/words.h"\n'}), [])

    def test_a_unit_that_asks_for_parameters_of_ros_is_left_in_peace(self):
        self.assertEqual(self.complaints(
            {"include/hires/ros/node/private_params.h": "#pragma once\n",
             "src/nodes/planner/params.cpp": '#include "hires/ros/node/private_params.h"\n'}), [])

    def test_names_of_topics_may_stand_where_topics_are(self):
        self.assertEqual(self.complaints(
            {"include/hires/ros/names/topic_names.h": "#pragma once\n",
             "src/nodes/planner/said.cpp":
                 '#include <ros/time.h>\n#include "hires/ros/names/topic_names.h"\n'}), [])

    def test_a_node_that_includes_another_one_is_found(self):
        pool = {"src/nodes/planner/pool.h": "#pragma once\n#include <ros/time.h>\n"}
        self.expect_one({**pool, "src/nodes/relay/relay_main.cpp": '#include "nodes/planner/pool.h"\n'},
                        "src/nodes/relay/relay_main.cpp:1", "another node")
        self.assertEqual(self.complaints(
            {**pool, "src/nodes/planner/pool.cpp": '#include "nodes/planner/pool.h"\n'}), [])

    def test_a_folder_of_too_many_units_is_found(self):
        def units(number, folder="src/base"):
            names = [f"{folder}/unit_{i}" for i in range(number)]
            return {**{f"{name}.h": "#pragma once\n" for name in names},
                    **{f"{name}.cpp": f'#include "{name[4:]}.h"\n' for name in names}}
        most = check_tree.MOST_UNITS - 1  # and rng.cpp
        self.assertEqual(self.complaints(units(most)), [])
        self.expect_one(units(most + 1), "src/base:", "26 units", "rooms by concept")
        self.assertEqual(self.complaints({**units(most), **units(9, "src/base/room")}), [])

    def test_a_dependency_that_cmake_does_not_know_is_found(self):
        self.expect_one({"src/geometry/CMakeLists.txt": "hires_layer(geometry LINK base)\n"},
                        "include/hires/geometry/pose.h:2", "DEPENDS", "'base'")

    def test_a_dependency_of_cmake_that_points_up_is_found(self):
        self.expect_one({"src/base/CMakeLists.txt": "hires_layer(base DEPENDS robot)\n"},
                        "src/base/CMakeLists.txt", "no lower layer")

    def test_a_dependency_of_cmake_that_nothing_includes_is_found(self):
        self.expect_one({"src/robot/CMakeLists.txt": "hires_layer(robot DEPENDS geometry base)\n"},
                        "src/robot/CMakeLists.txt", "'base'", "take it out")

    def test_a_dependency_that_comes_through_another_layer_is_declared_all_the_same(self):
        self.expect_one({"include/hires/robot/model.h":
                             '#pragma once\n#include "hires/geometry/pose.h"\n#include "hires/base/rng.h"\n'},
                        "include/hires/robot/model.h:3", "'base'", "add it to DEPENDS")

    ROOMS = {"src/robot/CMakeLists.txt": "hires_room(robot names\n  SOURCES names.cpp\n  DEPENDS base)\n"
                                         "hires_layer(robot DEPENDS robot/names geometry)\n",
             "include/hires/robot/names.h": '#pragma once\n#include "hires/base/rng.h"\n',
             "src/robot/names/names.cpp": '#include "hires/robot/names.h"\n',
             "src/skills/skill.cpp": '#include "hires/skills/skill.h"\n#include "hires/robot/names.h"\n'}

    def test_a_room_depends_on_what_it_includes_itself(self):
        self.assertEqual(self.complaints(self.ROOMS), [])
        self.expect_one({**self.ROOMS, "include/hires/robot/names.h":
                             '#pragma once\n#include "hires/base/rng.h"\n#include "hires/geometry/pose.h"\n'},
                        "include/hires/robot/names.h:3", "'robot/names'", "'geometry'", "add it to DEPENDS")

    def test_a_room_that_needs_the_rest_of_its_layer_is_found(self):
        self.expect_one({**self.ROOMS, "src/robot/model.cpp": '#include "hires/robot/model.h"\n',
                         "src/robot/names/names.cpp":
                             '#include "hires/robot/names.h"\n#include "hires/robot/model.h"\n'},
                        "src/robot/names/names.cpp:2", "'robot/names'", "'robot'")

    def test_who_needs_a_room_may_name_it_or_the_layer(self):
        for depends in ("robot", "robot/names robot"):
            self.assertEqual(self.complaints(
                {**self.ROOMS, "src/skills/CMakeLists.txt": f"hires_layer(skills DEPENDS {depends})\n"}), [])
        self.expect_one({**self.ROOMS, "src/robot/model.cpp": '#include "hires/robot/model.h"\n',
                         "src/skills/CMakeLists.txt": "hires_layer(skills DEPENDS robot/names)\n"},
                        "include/hires/skills/skill.h:2", "'robot'", "add it to DEPENDS")

    def test_rooms_that_need_each_other_are_found(self):
        complaints = self.complaints(
            {**self.ROOMS, "src/robot/CMakeLists.txt":
                 "hires_room(robot names DEPENDS robot/words base)\nhires_room(robot words DEPENDS robot/names)\n"
                 "hires_layer(robot DEPENDS geometry robot/names robot/words)\n",
             "src/robot/words/words.h": '#pragma once\n#include "hires/robot/names.h"\n',
             "src/robot/words/words.cpp": '#include "robot/words/words.h"\n',
             "src/robot/names/names.cpp":
                 '#include "hires/robot/names.h"\n#include "robot/words/words.h"\n'})
        self.assertEqual(len(complaints), 2, complaints)
        self.assertIn("'robot/names' DEPENDS on itself through others", complaints[0])

    def test_a_node_depends_on_what_it_includes_itself(self):
        node = {"src/nodes/planner/said.cpp": '#include <ros/time.h>\n#include "hires/base/rng.h"\n',
                "src/nodes/planner/planner_main.cpp": "int main() {}\n"}
        self.assertEqual(self.complaints(
            {**node, "src/nodes/CMakeLists.txt": "hires_node(planner SOURCES said.cpp DEPENDS base)\n"}), [])
        self.expect_one({**node, "src/nodes/CMakeLists.txt": "hires_node(planner SOURCES said.cpp)\n"},
                        "src/nodes/planner/said.cpp:2", "'nodes/planner'", "'base'")
        self.expect_one({**node, "src/nodes/CMakeLists.txt":
                             "hires_node(planner SOURCES said.cpp DEPENDS robot base)\n"},
                        "src/nodes/CMakeLists.txt", "'nodes/planner'", "'robot'", "take it out")

    def test_a_header_that_hides_one_of_ros_is_found(self):
        use = {"src/nodes/planner/pool.cpp": '#include <ros/time.h>\n#include "ros/names.h"\n'}
        self.assertIn("would be taken for the header <ros/names.h>",
                      "".join(self.complaints({**use, "src/ros/names.h": "#pragma once\n#include <ros/time.h>\n"})))
        lonely = {"include/hires/ros/names.h": "#pragma once\n#include <ros/time.h>\n",
                  "src/ros/names.cpp": '#include "hires/ros/names.h"\n'}
        self.assertEqual(self.complaints(lonely), [])

    def test_a_heavy_header_that_others_would_read_is_found(self):
        text = '#pragma once\n#include <nlohmann/%s>\n#include "hires/base/rng.h"\n'
        self.expect_one({"include/hires/geometry/pose.h": text % "json.hpp"},
                        "include/hires/geometry/pose.h:2", "json_fwd.hpp")
        self.assertEqual(self.complaints({"include/hires/geometry/pose.h": text % "json_fwd.hpp"}), [])

    def function_of(self, lines, head="void A::F(int a,\n          int b) {"):
        return '#include "hires/base/rng.h"\nnamespace a {\n%s\n%s}\n}  // namespace a\n' % (
            head, "  G();  // }\n" * (lines - 2 - head.count("\n")))

    def test_a_function_that_is_too_long_is_found(self):
        most = check_tree.MOST_LINES
        heads = ("void F() {", "void A::F(int a,\n          int b) {", "A::A(int a)\n    : a_{a},\n      b_(2) {",
                 "template <typename T>\nvoid F(T t) {")
        for head in heads:
            with self.subTest(head):
                self.assertEqual(self.complaints({"src/base/rng.cpp": self.function_of(most, head)}), [])
                self.expect_one({"src/base/rng.cpp": self.function_of(most + 1, head)},
                                "src/base/rng.cpp:3", f"{most + 1} lines", f"at most {most}")

    def test_a_long_method_in_a_class_is_found(self):
        body = "    G();\n" * check_tree.MOST_LINES
        self.expect_one({"include/hires/base/rng.h":
                             "#pragma once\nclass A {\n public:\n  void F() const {\n%s  }\n};\n" % body},
                        "include/hires/base/rng.h:4", f"{check_tree.MOST_LINES + 2} lines")

    def test_long_tables_types_and_texts_are_no_functions(self):
        many = check_tree.MOST_LINES + 9
        for text in ("const int kTable[] = {\n%s};\n" % ("    F(1),\n" * many),
                     "class A {\n%s};\n" % ("  int f(int);\n" * many),
                     "enum class A {\n%s};\n" % ("  kA,\n" * many),
                     'const char kText[] = R"(void F() {\n%s})";\n' % ("\n" * many)):
            with self.subTest(text[:12]):
                self.assertEqual(
                    self.complaints({"src/base/rng.cpp": '#include "hires/base/rng.h"\n' + text}), [])

    def test_a_source_without_its_header_is_found(self):
        self.expect_one({"src/base/lost.cpp": "\n"}, "src/base/lost.cpp",
                        "src/base/lost.h", "include/hires/base/lost.h")

    def test_a_source_may_implement_another_header_of_its_layer(self):
        self.assertEqual(self.complaints(
            {"src/base/rng_more.cpp": '#include "hires/base/rng.h"\n'}), [])
        self.assertEqual(self.complaints(
            {"src/base/inner.h": "#pragma once\n",
             "src/base/inner_more.cpp": '#include <vector>\n#include "inner.h"\n'}), [])
        self.expect_one({"src/geometry/more.cpp": '#include "hires/base/rng.h"\n'},
                        "src/geometry/more.cpp:1", "has no header")

    def test_a_source_that_does_not_begin_with_its_header_is_found(self):
        self.expect_one({"src/base/rng.cpp": '#include <vector>\n#include "hires/base/rng.h"\n'},
                        "src/base/rng.cpp:1", "start with its own header")

    def test_a_header_beside_its_source_is_enough(self):
        self.assertEqual(self.complaints({"src/base/inner.cpp": '#include "inner.h"\n',
                                          "src/base/inner.h": "#pragma once\n"}), [])

    def test_a_source_in_a_room_has_its_header_beside_it_or_for_others(self):
        self.assertEqual(self.complaints(
            {"src/base/room/inner.h": "#pragma once\n", "src/base/rng.cpp": None,
             "src/base/room/inner.cpp": '#include "base/room/inner.h"\n',
             "src/base/room/inner_more.cpp": '#include <vector>\n#include "base/room/inner.h"\n',
             "src/base/room/rng.cpp": '#include "hires/base/rng.h"\n'}), [])
        self.expect_one({"src/base/rng.cpp": None,
                         "src/base/room/rng.cpp": '#include <vector>\n#include "hires/base/rng.h"\n'},
                        "src/base/room/rng.cpp:1", "start with its own header")

    def test_headers_beside_their_sources_are_included_from_above_alone(self):
        inner = {"src/geometry/inner.h": "#pragma once\n"}
        include = '#include "geometry/inner.h"\n'
        self.assertEqual(self.complaints({**inner, "test/robot/a_test.cpp": include}), [])
        self.expect_one({**inner, "src/base/rng.cpp": '#include "hires/base/rng.h"\n' + include},
                        "src/base/rng.cpp:2", "an arrow up")

    def test_a_header_for_others_that_includes_one_that_is_not_installed_is_found(self):
        inner = {"src/base/inner.h": "#pragma once\n"}
        include = '#include "base/inner.h"\n'
        self.expect_one({**inner, "include/hires/base/rng.h": "#pragma once\n" + include},
                        "include/hires/base/rng.h:2", "not installed")
        self.expect_one({**inner, "examples/own/a.cpp": include}, "examples/own/a.cpp:1", "not installed")

    def test_what_names_the_lab_in_the_product_is_found(self):
        include = '#include "hires/base/rng.h"\n#include "lab/src/trial/random_tables.h"\n'
        self.expect_one({"src/base/rng.cpp": include}, "src/base/rng.cpp:2", "sees the lab")
        self.expect_one({"src/base/more/CMakeLists.txt": "target_link_libraries(a hires_lab)\n"},
                        "src/base/more/CMakeLists.txt:1", "names the lab")
        self.expect_one({"scripts/demo": "#!/bin/bash\nscripts/build hires_lab\n"}, "scripts/demo:2",
                        "names the lab")

    def test_a_header_for_others_that_only_its_layer_includes_is_found(self):
        lonely = {"include/hires/base/dice.h": "#pragma once\n",
                  "src/base/dice.cpp": '#include "hires/base/dice.h"\n',
                  "test/base/dice_test.cpp": '#include "hires/base/dice.h"\n'}
        self.expect_one(lonely, "include/hires/base/dice.h:1", "keep it beside")
        user = '#pragma once\n#include "hires/base/dice.h"\n'
        self.assertEqual(self.complaints({**lonely, "include/hires/base/rng.h": user}), [])
        self.assertEqual(self.complaints({**lonely, "examples/own/a.h": user}), [])

    def test_a_header_without_guard_is_found(self):
        self.expect_one({"include/hires/base/rng.h": "#include <cstdint>\n"}, "#pragma once")

    def test_tabs_and_trailing_white_space_are_found(self):
        self.expect_one({"docs/a.md": "one\ntwo\t2\n"}, "docs/a.md:2", "tab")
        self.expect_one({"docs/a.md": "one \ntwo\n"}, "docs/a.md:1", "white space")
        self.expect_one({"README.md": "one\r\n"}, "README.md:1", "white space")
        self.expect_one({"docs/a.md": "one"}, "docs/a.md:1", "line break")

    def test_packages_that_disagree_are_found(self):
        self.expect_one({"scripts/packages.txt": "ros-base-dev  # ROS [roscpp]\n"},
                        "package.xml", "opende")
        self.expect_one({"package.xml": "<package><depend>roscpp</depend></package>\n"},
                        "scripts/packages.txt:2", "[opende]")

    def test_bad_lines_of_the_package_list_are_found(self):
        good = GOOD_TREE["scripts/packages.txt"]
        self.expect_one({"scripts/packages.txt": good + "libfmt-dev\n"}, ":3", "reason")
        self.expect_one({"scripts/packages.txt": good + "a-dev b-dev  # both\n"}, ":3", "a line")
        self.expect_one({"scripts/packages.txt": good + "libode-dev  # again\n"}, ":3", "line 2")

    def test_libraries_that_are_looked_for_and_not_listed_are_found(self):
        good = GOOD_TREE["scripts/packages.txt"]
        for text, name in (("find_package(fcl REQUIRED)\n", "fcl"),
                           ("  pkg_check_modules(ODE REQUIRED IMPORTED_TARGET GLOBAL ode)\n", "ode")):
            self.expect_one({"CMakeLists.txt": text}, "CMakeLists.txt", f"<{name}>")
            listed = {"CMakeLists.txt": text, "scripts/packages.txt": f"{good}lib-dev  # a <{name}>\n"}
            self.assertEqual(self.complaints(listed), [])
        self.expect_one({"scripts/packages.txt": good + "lib-dev  # a <fcl>\n"}, ":3", "<fcl>")

    def test_a_catkin_component_that_package_xml_lacks_is_found(self):
        self.expect_one(
            {"cmake/HiresRos.cmake": "find_package(catkin REQUIRED COMPONENTS roscpp tf2)\n"},
            "tf2", "package.xml")

    def test_failure_codes_that_differ_are_found(self):
        tree = {"include/hires/base/failure.h": "#pragma once\nenum Code {\n  kNone = 0,\n  kStuck = 4,\n};\n",
                "src/base/failure.cpp": '#include "hires/base/failure.h"\n{Code::kStuck, "stuck"}\n',
                "msg/Failure.msg": "uint16 NONE=0\nuint16 STUCK=4\n",
                "src/robot/CMakeLists.txt": "hires_layer(robot DEPENDS geometry base)\n",
                "include/hires/robot/model.h":
                    '#pragma once\n#include "hires/base/failure.h"\n#include "hires/geometry/pose.h"\n'}
        self.assertEqual(self.complaints(tree), [])
        self.expect_one({**tree, "msg/Failure.msg": "uint16 NONE=0\nuint16 STUCK=5\n"},
                        "msg/Failure.msg", "STUCK is 5", "it is 4")
        self.expect_one({**tree, "msg/Failure.msg": "uint16 STUCK=4\nuint16 LATE=6\n"},
                        "LATE is 6", "missing")
        self.expect_one({**tree, "src/base/failure.cpp": '#include "hires/base/failure.h"\n',
                         "msg/Failure.msg": "uint16 NONE=0\n"}, "no row for kStuck")

    def test_instructions_that_lead_nowhere_are_found(self):
        text = "Open `src/base/rng.cpp`, `src/`, `scripts/build --where`\nand `src/base/dice.cpp`.\n"
        self.expect_one({"CONTRIBUTING.md": text}, "CONTRIBUTING.md:2", "no src/base/dice.cpp")

    def test_a_test_in_a_namespace_of_others_is_found(self):
        self.expect_one({"test/skills/look_test.cpp": "namespace hires::skills {\nnamespace {\n}\n}\n"},
                        "test/skills/look_test.cpp:1", "namespace hires::skills::look_test")

    def test_rostests_that_would_hide_what_fails_are_found(self):
        for line in ("rosunit.unitrun('hires', 'a', ATest)", "rostest.rosrun('hires', 'a', ATest)",
                     "from rosunit import unitrun"):
            self.expect_one({"test/ros/a_test.py": "import rosunit\n" + line + "\n"},
                            "test/ros/a_test.py:2", "subTest", "run_test")
        for path, line in (("test/ros/a_test.py", "run_test('a', ATest)"),
                           ("test/ros/a_test.py", "from rosunit import junitxml"),
                           ("test/ros/support/test_run.py", "rosunit.unitrun")):
            self.assertEqual(self.complaints({path: line + "\n"}), [])

    def test_scripts_that_cannot_be_read_are_found(self):
        self.expect_one({"scripts/build": "#!/bin/bash\nif true; then\n"}, "scripts/build", "bash")
        self.expect_one({"scripts/table": "#!/usr/bin/env python3\nprint(\n"},
                        "scripts/table", "python")

    TABLE = {"src/base/failure.cpp":
             '#include "hires/base/rng.h"\n{Code::kNoPath, "no_path"}, {Code::kBusy, "busy"}\n'}

    def test_a_failure_word_outside_of_its_table_is_found(self):
        start = '#include "hires/robot/model.h"\n'
        for text in ('return "no_path";', 'Fail("no_path: a touches b");'):
            self.expect_one({**self.TABLE, "src/robot/a.cpp": start + text + "\n"},
                            "src/robot/a.cpp:2", "'no_path'", "FailureCode")
        for text in ('// fails with "no_path"', '/* "no_path" */', 'Show("no_path_here");'):
            self.assertEqual(
                self.complaints({**self.TABLE, "src/robot/a.cpp": start + text + "\n"}), [])
        self.assertEqual(
            self.complaints({**self.TABLE, "test/robot/a.cpp": start + 'E("no_path");\n'}), [])

    def test_a_word_that_means_something_else_is_left_in_peace_where_it_does(self):
        text = '#include "hires/robot/model.h"\nreturn "busy";\n'
        self.expect_one({**self.TABLE, "src/robot/a.cpp": text}, "src/robot/a.cpp:2", "'busy'")
        path = "src/loop/achieve.cpp"
        self.assertEqual(self.complaints({**self.TABLE, path: '#include "a.h"\n' + text.split("\n")[1] + "\n",
                                          "src/loop/a.h": "#pragma once\n"}), [])

    def test_words_for_people_that_are_taken_apart_are_found(self):
        start = '#include "hires/robot/model.h"\n'
        for text in ('if (x.reason == "late") return;', 'x.reason.rfind("a", 0);',
                     'failure.detail.substr(2);', 'if (ToString(failure) == other) return;',
                     'if ("late" == x.reason) return;', 'if ("late" != why()) return;',
                     'if (other == ToString(failure)) return;'):
            self.expect_one({**self.TABLE, "src/robot/a.cpp": start + text + "\n"},
                            "src/robot/a.cpp:2", "for people")
        for text in ('if (why.empty()) return;', 'failures.find(code);', 'a.failure == b.failure;',
                     'if (a == "x") return b.reason;', 'F("x", reason == other);'):
            self.assertEqual(
                self.complaints({**self.TABLE, "src/robot/a.cpp": start + text + "\n"}), [])

    def test_python_that_takes_words_for_people_apart_is_found(self):
        for text in ("if reason == 'late':", "if 'late' != step.failure.detail:", "why.split(',')",
                     "if x.reason in ('late', 'lost'):", "result.reason.startswith('no way')"):
            for path in ("test/ros/a_test.py", "examples/own/a.py", "scripts/a.py"):
                self.expect_one({path: "x = 1\n" + text + "\n"}, path + ":2", "for people")
        for text in ("self.assertIn('late', result.reason)", "if step.failure.code == code:",
                     "if not why:", "# reason == 'late'", "say(reason or '-')"):
            self.assertEqual(self.complaints({"test/ros/a_test.py": text + "\n"}), [])

    def test_a_document_that_invents_a_failure_is_found(self):
        table = "| action | fails with |\n|---|---|\n| `look` | `no_path: a`, `%s` |\n\n`other`\n"
        self.assertEqual(self.complaints({**self.TABLE, "docs/a.md": table % "busy"}), [])
        self.expect_one({**self.TABLE, "docs/a.md": table % "lost"}, "docs/a.md:3", "'lost'")

    def test_only_the_simulated_robot_and_the_command_line_name_the_truth(self):
        listening = {"planner.cpp": 'nh.subscribe("ground_truth/world_state", 1, &Note);\n'}
        self.assertEqual(self.truths_in("src/nodes/sim_worker", listening), [])
        self.assertEqual(len(self.truths_in("src/nodes/hires", listening)), 1)
        found = self.truths_in("src/nodes/planner", listening)
        self.assertEqual(len(found), 1)
        self.assertIn("src/nodes/planner/planner.cpp:1: names the topic of the truth", found[0])

    def truths_in(self, folder, files):
        changes = {os.path.join(folder, name): text for name, text in files.items()}
        return [c for c in self.complaints(changes) if "truth" in c]


if __name__ == "__main__":
    unittest.main()
