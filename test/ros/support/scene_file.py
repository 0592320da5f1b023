"""The configured scene, to be changed and written to any folder."""

import os

import yaml

CONFIG = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', '..', 'config'))
FILES = ('world', 'robot', 'objects', 'uncertainty', 'detector', 'obstacle_layer')


def read_scene():
    """What config/scene.yaml says, with absolute paths."""
    with open(os.path.join(CONFIG, 'scene.yaml')) as file:
        scene = yaml.safe_load(file)
    for key in FILES:
        scene[key] = os.path.join(CONFIG, scene[key])
    return scene
