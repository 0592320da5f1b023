#include "python/arguments.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <variant>

#include "hires/base/short_text.h"
#include "hires/base/text.h"

namespace py = pybind11;

namespace hires::python {
namespace {

struct Wanted {
  std::string words;
  bool (*fits)(const py::handle& value);
};

template <typename T>
bool Fits(const py::handle& value) {
  return py::detail::make_caster<T>().load(value, true);
}

/// By the names of arguments, which mean the same in every method.
const std::map<std::string, Wanted>& AllWanted() {
  using Names = std::vector<std::string>;
  const Wanted text{"a text", Fits<std::string>};
  const Wanted names{"a list of texts", Fits<Names>};
  const Wanted number{"a number", Fits<double>};
  const Wanted whole{"a whole number of at most 2147483647", Fits<int>};
  static const std::map<std::string, Wanted> wanted{
      {"world", text},
      {"map", text},
      {"robot", text},
      {"objects", names},
      {"catalogue", text},
      {"areas",
       {"{name: (x, y, yaw)}, or the name of a file",
        Fits<std::variant<std::string, std::map<std::string, std::array<double, 3>>>>}},
      {"uncertainty", text},
      {"actions", names},
      {"config", text},
      {"name", text},
      {"speed", number},
      {"acceleration", number},
      {"turn_speed", number},
      {"turn_acceleration", number},
      {"action", text},
      {"robot_at", text},
      {"on_tray", names},
      {"facts", names},
      {"put", {"{object: (x, y, z, yaw)}", Fits<std::map<std::string, std::array<double, 4>>>}},
      {"rollouts", whole},
      {"rollout", whole},
      {"threads", whole},
      {"seed", {"a whole number from 0 on", Fits<std::uint64_t>}},
      {"deadline", number},
      {"ranking", text},
      {"min_success", number},
      {"max_regret", number},
      {"early_stop", {"True or False", Fits<bool>}}};
  return wanted;
}

[[noreturn]] void Fail(const std::string& method, const std::string& argument,
                       const py::handle& value, const std::string& wanted) {
  constexpr std::size_t kShown = 60;
  throw py::type_error(fmt::format("{}: {} is {} ({}), wanted {}", method, argument,
                                   base::Shortened(py::repr(value).cast<std::string>(), kShown),
                                   py::type::of(value).attr("__name__").cast<std::string>(),
                                   wanted));
}

/// What `method` was called with; the first is the object itself.
void CheckPositional(const std::string& method, const py::args& positional) {
  const bool has_ways = method == "imagine";
  for (std::size_t i = 1; i < positional.size(); ++i) {
    const py::handle value = positional[i];
    const bool is_way = has_ways && i > 1 && Fits<std::vector<std::string>>(value);
    if (is_way || Fits<std::string>(value)) continue;
    Fail(method, fmt::format("argument {}", i), value,
         has_ways && i > 1 ? "a text, or a list of texts to choose from" : "a text");
  }
}

void CheckNamed(const std::string& method, const py::kwargs& named) {
  for (const auto& [key, value] : named) {
    const auto name = key.cast<std::string>();
    const auto wanted = AllWanted().find(name);
    if (wanted != AllWanted().end() && !wanted->second.fits(value)) {
      Fail(method, name, value, wanted->second.words);
    }
  }
}

/// Of the signature, as Python tells it: "(self, *, world: str = '', map: ...".
void CheckNames(const std::string& method, const std::string& signature, const py::kwargs& named) {
  std::vector<std::string> known;
  for (const auto& [name, wanted] : AllWanted()) {
    if (signature.find(" " + name + ":") != std::string::npos) known.push_back(name);
  }
  for (const auto& [key, value] : named) {
    const auto name = key.cast<std::string>();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw py::type_error(method + ": " + base::UnknownName("argument", name, known));
  }
}

void NameWrongArguments(const py::object& type, const std::string& method) {
  const py::object original = type.attr(method.c_str());
  const py::object documentation = original.attr("__doc__");
  const auto signature = documentation.cast<std::string>();
  const std::string shown = method == "__init__" ? "Scene" : method;
  const auto call = [original, shown, signature](const py::args& positional,
                                                 const py::kwargs& named) -> py::object {
    try {
      return original(*positional, **named);
    } catch (const py::error_already_set& error) {
      // A name that is no text among an action's arguments fails as it is converted.
      if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_RuntimeError)) throw;
      CheckNamed(shown, named);
      CheckPositional(shown, positional);
      CheckNames(shown, signature, named);
      throw;
    }
  };
  py::options options;
  options.disable_function_signatures();
  // Not called __init__ to pybind11, which would take it for one that makes the object.
  type.attr(method.c_str()) =
      py::cpp_function(call, py::name(shown.c_str()), py::is_method(type), signature.c_str());
}

}  // namespace

void NameWrongArguments(const py::object& type, const std::vector<std::string>& methods) {
  for (const std::string& method : methods) NameWrongArguments(type, method);
}

}  // namespace hires::python
