"""Pr2GripperCommand, from its published definition: its package is not in Debian."""

import struct

import genpy


class Pr2GripperCommand(genpy.Message):
    _md5sum = '680acaff79486f017132a7f198d40f08'
    _type = 'pr2_controllers_msgs/Pr2GripperCommand'
    _has_header = False
    _full_text = 'float64 position\nfloat64 max_effort\n'
    __slots__ = ['position', 'max_effort']
    _slot_types = ['float64', 'float64']
    _layout = struct.Struct('<2d')

    def __init__(self, position=0.0, max_effort=0.0):
        super().__init__()
        self.position, self.max_effort = position, max_effort

    def serialize(self, buff):
        buff.write(self._layout.pack(self.position, self.max_effort))

    def deserialize(self, data):
        self.position, self.max_effort = self._layout.unpack(data[:self._layout.size])
        return self
