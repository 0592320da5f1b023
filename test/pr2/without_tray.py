#!/usr/bin/env python3
"""Prints a robot's URDF without its tray, as a PR2's own robot_description is."""

import sys
import xml.etree.ElementTree as ElementTree

TRAY = ('base_tray_link', 'base_tray_laser_link')


def main():
    robot = ElementTree.parse(sys.argv[1]).getroot()
    for element in list(robot):
        child = element.find('child')
        is_its_joint = element.tag == 'joint' and child.get('link') in TRAY
        if is_its_joint or element.get('name') in TRAY or element.get('reference') in TRAY:
            robot.remove(element)
    print(ElementTree.tostring(robot, encoding='unicode'))


if __name__ == '__main__':
    main()
