#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace hires::python {

/// Has these methods of a class say, of an argument of a wrong type, which it is, what came and
/// what was wanted, instead of listing all that pybind11 would take.
void NameWrongArguments(const pybind11::object& type, const std::vector<std::string>& methods);

}  // namespace hires::python
