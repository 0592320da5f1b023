#!/usr/bin/python3 -B
"""Stands in for ROS's xacro where that is not installed (Debian has no package of it), in tests alone.

Usage: xacro FILE [name:=value ...]. It knows what the examples use: arguments, properties, macros
with parameters that are texts, and expressions of names, numbers, + - * /.
"""

import copy
import re
import sys
import xml.etree.ElementTree as ET

PREFIX = "{http://www.ros.org/wiki/xacro}"


def expand_text(text, values, arguments):
    """`$(arg a)`, then `${expression}`: of a text alone the text, else a number."""
    text = re.sub(r"\$\(arg (\w+)\)", lambda found: arguments[found.group(1)], text)

    def value_of(found):
        expression = found.group(1).strip()
        if expression in values:
            return values[expression]
        numbers = {name: float(value) for name, value in values.items()
                   if re.fullmatch(r"-?[\d.]+", value)}
        if not re.fullmatch(r"[\w\s.+*/()-]+", expression):
            sys.exit("xacro (stand-in): cannot evaluate '%s'" % expression)
        return "%g" % eval(expression, {"__builtins__": {}}, numbers)  # pylint: disable=eval-used

    return re.sub(r"\$\{([^}]*)\}", value_of, text)


def expand(element, values, arguments, macros):
    """Replaces the children of `element` by what they stand for."""
    children = list(element)
    for child in children:
        element.remove(child)
    for key, text in element.attrib.items():
        element.set(key, expand_text(text, values, arguments))
    if element.text:
        element.text = expand_text(element.text, values, arguments)
    for child in children:
        name = child.tag[len(PREFIX):] if str(child.tag).startswith(PREFIX) else None
        if name == "arg":
            arguments.setdefault(child.get("name"), child.get("default"))
        elif name == "property":
            values[child.get("name")] = expand_text(child.get("value"), values, arguments)
        elif name == "macro":
            macros[child.get("name")] = child
        elif name in macros:
            given = {key: expand_text(text, values, arguments)
                     for key, text in child.attrib.items()}
            body = copy.deepcopy(macros[name])
            body.attrib.clear()
            expand(body, {**values, **given}, arguments, macros)
            element.extend(list(body))
        elif name is not None:
            sys.exit("xacro (stand-in): unknown macro name: xacro:%s" % name)
        else:
            expand(child, values, arguments, macros)
            element.append(child)


def main():
    root = ET.parse(sys.argv[1]).getroot()
    expand(root, {}, dict(word.split(":=", 1) for word in sys.argv[2:]), {})
    print(ET.tostring(root, encoding="unicode"))


if __name__ == "__main__":
    main()
