#!/usr/bin/env python3
"""What the scripts say and refuse, as far as it can be seen without building or installing."""

import os
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "../.."))


def run(script, *arguments, **environment):
    return subprocess.run([os.path.join(ROOT, script), *arguments], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, check=False,
                          env={**os.environ, **environment})


class ScriptsTest(unittest.TestCase):
    def test_every_script_explains_itself(self):
        for script in ("benchmark", "build", "check_limits", "demo", "format", "on_host", "package",
                       "replay_episodes", "run", "setup", "test", "tidy"):
            with self.subTest(script):
                answer = run(f"scripts/{script}", "--help")
                self.assertEqual(answer.returncode, 0, answer.stderr)
                self.assertIn(f"scripts/{script}", answer.stdout)

    def setup_on(self, release):
        with tempfile.NamedTemporaryFile("w", suffix=".os-release") as file:
            file.write(release)
            file.flush()
            return run("scripts/setup", HIRES_OS_RELEASE=file.name)

    def test_setup_refuses_another_system_and_names_what_to_install(self):
        answer = self.setup_on('ID=fedora\nVERSION_ID=39\nPRETTY_NAME="Fedora Linux 39"\n')
        self.assertEqual(answer.returncode, 1)
        self.assertIn("this is Fedora Linux 39", answer.stderr)
        self.assertIn("libode-dev", answer.stderr)

    def test_setup_tells_ubuntu_20_04_its_own_names(self):
        answer = self.setup_on('ID=ubuntu\nVERSION_ID="20.04"\nPRETTY_NAME="Ubuntu 20.04.6 LTS"\n')
        self.assertEqual(answer.returncode, 1)
        self.assertIn("ros-noetic-ros-base", answer.stderr)
        self.assertIn("libsdformat12-dev", answer.stderr)
        self.assertNotIn("ros-base-dev\n", answer.stderr)

    def test_setup_refuses_a_system_that_does_not_say_what_it_is(self):
        answer = self.setup_on("")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("unknown system", answer.stderr)

    def test_setup_knows_the_parts_of_the_list(self):
        everything, build, run_part = (run("scripts/setup", "--list", *part).stdout.split()
                                       for part in ([], ["build"], ["run"]))
        self.assertIn("libode-dev", build)
        self.assertNotIn("libgtest-dev", build)
        self.assertIn("python3-rospy", run_part)
        self.assertEqual([name for name in run_part if name.endswith("-dev")], [])
        rest = run("scripts/setup", "--list", "perception", "package", "show", "develop", "long").stdout.split()
        self.assertEqual(sorted(everything), sorted(build + run_part + rest))

    def test_setup_brings_large_peers_only_when_asked(self):
        everything, peers = (run("scripts/setup", "--list", *part).stdout.split()
                             for part in ([], ["peers"]))
        self.assertIn("libmrpt-slam-dev", peers)
        self.assertEqual([name for name in peers if name in everything], [])

    def test_setup_refuses_a_part_that_is_none(self):
        answer = run("scripts/setup", "--list", "runn")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("no part 'runn'", answer.stderr)
        self.assertIn("build perception run package show develop", answer.stderr)

    def test_the_build_folder_lies_outside_of_the_sources(self):
        folder = run("scripts/build", "--where", HIRES_BUILD="", XDG_CACHE_HOME="/cache").stdout
        self.assertRegex(folder, r"^/cache/hires/[0-9a-f]{12}\n$")

    def test_the_build_folder_can_be_chosen(self):
        answer = run("scripts/build", "--where", HIRES_BUILD="/elsewhere")
        self.assertEqual(answer.stdout, "/elsewhere\n")

    def test_unknown_options_end_with_the_help_text(self):
        for script in ("build", "package", "run", "setup"):
            with self.subTest(script):
                answer = run(f"scripts/{script}", "--nonsense")
                self.assertEqual(answer.returncode, 2)
                self.assertIn(f"scripts/{script}", answer.stderr)

    def run_in_fake_build(self, *command, **environment):
        """scripts/run in a build folder whose setup.bash notes its arguments and nothing else."""
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "devel"))
            open(os.path.join(folder, ".built"), "w", encoding="utf-8").close()
            with open(os.path.join(folder, "devel", "setup.bash"), "w", encoding="utf-8") as file:
                file.write('export SEEN_BY_SETUP="$*" UNSET="$NEVER_SET" ROS_PACKAGE_PATH=/build/src\n')
            return run("scripts/run", *command, HIRES_BUILD=folder, **environment)

    def test_run_keeps_the_arguments_of_the_command_for_the_command(self):
        answer = self.run_in_fake_build("bash", "-c", 'echo "$SEEN_BY_SETUP|$0|$1"', "--help", "a b")
        self.assertEqual(answer.stdout, "|--help|a b\n", answer.stderr)

    def test_run_binds_to_loopback_unless_told_otherwise(self):
        show = ("bash", "-c", 'echo "$ROS_HOSTNAME|$ROS_IP"')
        answer = self.run_in_fake_build(*show, ROS_HOSTNAME="", ROS_IP="")
        self.assertEqual(answer.stdout, "localhost|\n")
        answer = self.run_in_fake_build(*show, ROS_HOSTNAME="", ROS_IP="10.0.0.7")
        self.assertEqual(answer.stdout, "|10.0.0.7\n")

    def test_run_keeps_the_packages_of_the_users_workspace(self):
        answer = self.run_in_fake_build("bash", "-c", 'echo "$ROS_PACKAGE_PATH"',
                                        ROS_PACKAGE_PATH="/robot/src:/other")
        self.assertEqual(answer.stdout, "/build/src:/robot/src:/other\n")

    def on_host(self, files, **environment):
        """What an installed on_host runs with: files {path: text} lie beside it."""
        with tempfile.TemporaryDirectory() as prefix:
            scripts = os.path.join(prefix, "share", "hires", "scripts")
            os.makedirs(scripts)
            shutil.copy(os.path.join(ROOT, "scripts", "on_host"), scripts)
            for path, text in files.items():
                with open(os.path.join(prefix, path), "w", encoding="utf-8") as file:
                    file.write("#!/bin/sh\n" + text)
                os.chmod(file.name, 0o755)
            return run(os.path.join(scripts, "on_host"), "sh", "-c", 'echo "$ENTERED|$ROS_IP"',
                       **{"ROS_IP": "", "ROS_HOSTNAME": "", "HIRES_ENTER": "", **environment})

    def test_on_host_enters_the_workspace_that_it_is_installed_in(self):
        ssh = "10.0.0.1 2222 10.0.0.2 22"
        files = {"env.sh": 'ENTERED=env exec "$@"\n'}
        self.assertEqual(self.on_host(files, SSH_CONNECTION=ssh).stdout, "env|10.0.0.2\n")
        self.assertEqual(self.on_host(files, SSH_CONNECTION="", ROS_IP="10.0.0.3").stdout, "env|10.0.0.3\n")
        self.assertEqual(self.on_host({}, SSH_CONNECTION=ssh).stdout, "|10.0.0.2\n")
        checkout = {**files, "share/hires/scripts/run": 'ENTERED=run exec "$@"\n'}
        self.assertEqual(self.on_host(checkout, SSH_CONNECTION=ssh).stdout, "run|10.0.0.2\n")

    def test_on_host_says_where_an_address_is_missing(self):
        answer = self.on_host({}, SSH_CONNECTION="")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("set ROS_IP", answer.stderr)

    def test_run_ends_as_the_command_ended(self):
        self.assertEqual(self.run_in_fake_build("bash", "-c", "exit 7").returncode, 7)

    def test_run_wants_a_command(self):
        self.assertEqual(run("scripts/run").returncode, 2)


class LaunchFilesTest(unittest.TestCase):
    def test_what_many_nodes_print_comes_in_order_also_in_a_file(self):
        # In a file the C library would keep back what is no warning.
        for name in ("closed_loop", "imagination", "pr2"):
            with self.subTest(name):
                launch = ElementTree.parse(os.path.join(ROOT, "launch", f"{name}.launch")).getroot()
                before_nodes = {}
                for tag in launch:
                    if tag.tag in ("group", "include", "node"):
                        break
                    if tag.tag == "env":
                        before_nodes[tag.get("name")] = tag.get("value")
                self.assertEqual(before_nodes.get("ROSCONSOLE_STDOUT_LINE_BUFFERED"), "1")


class RunCtestTest(unittest.TestCase):
    def results_of(self, tests, *arguments):
        """The suite that test/run_ctest.py writes of a build folder with these tests {name: command}."""
        with tempfile.TemporaryDirectory() as build:
            with open(os.path.join(build, "CTestTestfile.cmake"), "w", encoding="utf-8") as file:
                file.writelines(f"add_test({name} {command})\n" for name, command in tests.items())
            path = os.path.join(build, "results", "ctest.xml")
            answer = run("test/run_ctest.py", path, build, *arguments)
            self.assertEqual(answer.returncode, 0, answer.stderr)
            return ElementTree.parse(path).getroot().attrib

    def test_catkin_can_read_how_many_failed(self):
        suite = self.results_of({"good": "true", "bad": "false", "fine": "true"})
        self.assertEqual([suite[name] for name in ("tests", "failures", "errors")], ["3", "1", "0"])

    def test_no_results_are_a_failure(self):
        suite = self.results_of({"good": "true"}, "--no-such-option=1", "--test-dir", "/nowhere/at/all")
        self.assertEqual([suite[name] for name in ("tests", "failures", "errors")], ["1", "1", "0"])


if __name__ == "__main__":
    unittest.main()
