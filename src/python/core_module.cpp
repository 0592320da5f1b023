// `hires.core`: the ROS-free part of HIRES for Python. What a name means stands in its docstring,
// and in docs/own_code.md.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <variant>

#include "hires/base/error.h"
#include "python/answer.h"
#include "python/arguments.h"
#include "python/scene.h"
#include "reports/text/report_json.h"

namespace py = pybind11;
using hires::imagination::Prediction;
using hires::imagination::RolloutRecording;
using hires::imagination::RolloutSample;
using hires::python::Answer;
using hires::python::Request;
using hires::python::Scene;
using hires::python::SceneFiles;
using hires::python::StartOfAction;
using py::literals::operator""_a;

namespace {

/// Plays without holding the interpreter, so that its other threads run, and lets Ctrl-C end it.
/// @param play  called with what asks whether to stop.
template <typename Play>
auto PlayUnlocked(const Play& play) {
  bool is_interrupted = false;
  const auto cancelled = [&] {
    const py::gil_scoped_acquire lock;
    is_interrupted = is_interrupted || PyErr_CheckSignals() != 0;
    return is_interrupted;
  };
  auto result = [&] {
    const py::gil_scoped_release unlocked;
    return play(cancelled);
  }();
  if (is_interrupted) throw py::error_already_set();
  return result;
}

/// Where config/, worlds/ and urdf/ lie: beside what is installed, or in the source tree.
std::string PackageFolder() {
  const auto path = py::module_::import("os.path");
  const py::object module = py::module_::import("hires.core").attr("__file__");
  py::object folder = path.attr("realpath")(path.attr("dirname")(module));
  while (path.attr("dirname")(folder).cast<std::string>() != folder.cast<std::string>()) {
    folder = path.attr("dirname")(folder);
    const py::object share = path.attr("join")(folder, "share", "hires");
    if (path.attr("exists")(path.attr("join")(share, "config", "scene.yaml")).cast<bool>()) {
      return share.cast<std::string>();
    }
  }
  return HIRES_SOURCE_DIR;
}

/// [samples x width], one row per sample.
template <typename RowOf>
py::array_t<double> Table(const RolloutRecording& recording, int width, const RowOf& row_of) {
  py::array_t<double> table(
      {static_cast<py::ssize_t>(recording.samples.size()), static_cast<py::ssize_t>(width)});
  auto cells = table.mutable_unchecked<2>();
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const Eigen::VectorXd row = row_of(recording.samples[i]);
    for (int column = 0; column < width; ++column) cells(i, column) = row[column];
  }
  return table;
}

template <typename ValueOf>
py::array_t<double> Column(const RolloutRecording& recording, const ValueOf& value_of) {
  py::array_t<double> column(static_cast<py::ssize_t>(recording.samples.size()));
  auto cells = column.mutable_unchecked<1>();
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    cells(i) = value_of(recording.samples[i]);
  }
  return column;
}

Eigen::VectorXd InPlane(const hires::geometry::Twist2& twist) {
  return Eigen::Vector3d(twist.vx, twist.vy, twist.wz);
}

/// {name: what `table_of` gives for it}, by the place of the object among the samples' poses.
template <typename TableOf>
py::dict PerObject(const RolloutRecording& recording, const TableOf& table_of) {
  py::dict tables;
  for (std::size_t o = 0; o < recording.objects.size(); ++o) {
    tables[py::str(recording.objects[o])] = table_of(o);
  }
  return tables;
}

py::dict Joints(const RolloutRecording& recording) {
  py::dict joints;
  if (recording.samples.empty()) return joints;
  for (const auto& [name, position] : recording.samples.front().joints) {
    joints[py::str(name)] = Column(recording, [&joint = name](const RolloutSample& sample) {
      return sample.joints.at(joint);
    });
  }
  return joints;
}

py::tuple PairOf(double first, double second) { return py::make_tuple(first, second); }

void BindAlternative(py::module_* m) {
  py::class_<Prediction>(*m, "Alternative", "What imagination found about one way to act.")
      .def("__repr__",
           [](const Prediction& p) {
             return fmt::format("Alternative({}: success {:.3f} of {} rollouts)",
                                ToString(p.action), p.evidence.success.share,
                                p.evidence.num_rollouts);
           })
      .def_property_readonly("action", [](const Prediction& p) { return p.action.name; })
      .def_property_readonly(
          "arguments", [](const Prediction& p) { return py::tuple(py::cast(p.action.arguments)); })
      .def_property_readonly(
          "success", [](const Prediction& p) { return p.evidence.success.share; },
          "Share of rollouts that succeeded, 0 .. 1.")
      .def_property_readonly(
          "interval",
          [](const Prediction& p) {
            return PairOf(p.evidence.success.lower, p.evidence.success.upper);
          },
          "95 %, of the probability of success.")
      .def_property_readonly("rollouts",
                             [](const Prediction& p) { return p.evidence.num_rollouts; })
      .def_property_readonly(
          "falls", [](const Prediction& p) { return p.evidence.falls; }, "Events, in all rollouts.")
      .def_property_readonly(
          "confidence", [](const Prediction& p) { return p.evidence.confidence_pooled; },
          "Eq. 6.1 of the dissertation.")
      .def_property_readonly(
          "duration",
          [](const Prediction& p) {
            return p.evidence.durations.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                : p.evidence.duration.mean;
          },
          "[s] mean of the rollouts that came to their end; nan: none did.")
      .def_property_readonly(
          "durations",
          [](const Prediction& p) {
            return py::array_t<double>(static_cast<py::ssize_t>(p.evidence.durations.size()),
                                       p.evidence.durations.data());
          },
          "[s] of the same rollouts, ascending.")
      .def_property_readonly(
          "tilt",
          [](const Prediction& p) {
            return PairOf(p.evidence.max_tilt.p50, p.evidence.max_tilt.p95);
          },
          "[rad] the largest tilt in 50 and in 95 of 100 rollouts.")
      .def_property_readonly(
          "expected_cost",
          [](const Prediction& p) {
            return p.evidence.cost ? p.evidence.cost->mean
                                   : std::numeric_limits<double>::quiet_NaN();
          },
          "[s] duration and price of failures; nan: no prices are known.")
      .def_property_readonly("failures", hires::python::FailuresOf,
                             "{failure as `hires imagine` prints it: rollouts}")
      .def("__str__", hires::python::TextOf);
}

void BindAnswer(py::module_* m) {
  py::class_<Answer>(*m, "Answer", "The answer to one request.")
      .def_property_readonly(
          "outcome", [](const Answer& a) { return hires::reports::OutcomeName(a.report); },
          "'ranked', 'ranked_at_deadline', 'close', 'all_failed', 'undecided', 'nothing_finished'")
      .def_property_readonly(
          "why", [](const Answer& a) { return a.report.why; }, "One sentence.")
      .def_property_readonly(
          "ranking", [](const Answer& a) { return a.report.ranking; }, "Best first.")
      .def_property_readonly(
          "recommended",
          [](const Answer& a) -> std::optional<Prediction> {
            if (a.report.recommended < 0) return std::nullopt;
            return a.report.ranking[static_cast<std::size_t>(a.report.recommended)];
          },
          "None: imagination recommends nothing.")
      .def_property_readonly(
          "odds",
          [](const Answer& a) -> std::optional<std::pair<double, double>> {
            if (!a.report.by_cost) return std::nullopt;
            return std::make_pair(a.report.by_cost->probability, a.report.by_cost->regret);
          },
          "P(best) and expected regret [s] of the recommended one. None: not by cost.")
      .def_property_readonly(
          "caveats", [](const Answer& a) { return a.report.caveats; },
          "What speaks against trusting it.")
      .def_property_readonly("seed", [](const Answer& a) { return a.report.seed; })
      .def("json", hires::python::JsonOf, "What `hires imagine --json` writes, as text.");
}

void BindRecording(py::module_* m) {
  py::class_<RolloutRecording>(*m, "Recording",
                               "One rollout, 20 samples a simulated second, as NumPy arrays.")
      .def_property_readonly(
          "time",
          [](const RolloutRecording& r) { return Column(r, [](auto& s) { return s.time; }); },
          "[s] since the action began; before it the load settles.")
      .def_property_readonly(
          "position",
          [](const RolloutRecording& r) {
            return Table(r, 3, [](auto& s) { return s.X_MB.translation; });
          },
          "[m] of the base in the map, n x 3.")
      .def_property_readonly(
          "orientation",
          [](const RolloutRecording& r) {
            return Table(r, 4, [](auto& s) { return s.X_MB.rotation.coeffs(); });
          },
          "Of the base in the map, quaternions x y z w, n x 4.")
      .def_property_readonly(
          "velocity",
          [](const RolloutRecording& r) {
            return Table(r, 3, [](auto& s) { return InPlane(s.V_B); });
          },
          "Of the base in its own frame: forward, left [m/s], turn [rad/s]; n x 3.")
      .def_property_readonly(
          "acceleration",
          [](const RolloutRecording& r) {
            return Table(r, 3, [](auto& s) { return InPlane(s.A_B); });
          },
          "Its derivative [m/s^2], [rad/s^2]; n x 3.")
      .def_property_readonly("joints", Joints, "{joint: positions [rad] or [m], n}")
      .def_property_readonly(
          "objects",
          [](const RolloutRecording& r) {
            return PerObject(r, [&](std::size_t o) {
              return Table(r, 3, [o](auto& s) { return s.X_MO[o].translation; });
            });
          },
          "{object: positions in the map [m], n x 3}")
      .def_property_readonly(
          "tilts",
          [](const RolloutRecording& r) {
            return PerObject(r, [&](std::size_t o) {
              return Column(r,
                            [o](auto& s) { return hires::geometry::TiltOf(s.X_MO[o].rotation); });
            });
          },
          "{object: how far it leans [rad], n}")
      .def_property_readonly("events", hires::python::EventsOf, "[(time [s], what happened)]")
      .def_property_readonly(
          "succeeded",
          [](const RolloutRecording& r) { return !hires::imagination::FailureOf(r.result); })
      .def_property_readonly("failure", hires::python::FailureTextOf, "'' if it succeeded.")
      .def_property_readonly(
          "duration", [](const RolloutRecording& r) { return r.result.duration; },
          "[s] of the action alone.")
      .def_property_readonly("falls", [](const RolloutRecording& r) { return r.result.falls; });
}

using AreasByName = std::map<std::string, std::array<double, 3>>;
using AreasGiven = std::variant<std::string, AreasByName>;  // or a file

Scene MakeScene(const std::string& world, const std::string& map, const std::string& robot,
                const std::vector<std::string>& objects, const std::string& catalogue,
                const AreasGiven& areas, const std::string& uncertainty,
                const std::vector<std::string>& actions, const std::string& config) {
  SceneFiles files;
  files.config = config.empty() ? PackageFolder() + "/config/imagination_client.yaml" : config;
  files.world = world;
  files.map = map;
  files.robot = robot;
  files.objects = objects;
  files.catalogue = catalogue;
  if (const auto* file = std::get_if<std::string>(&areas)) {
    files.area_files.push_back(*file);
  } else {
    files.areas = std::get<AreasByName>(areas);
  }
  files.uncertainty = uncertainty;
  files.actions = actions;
  const py::gil_scoped_release unlocked;
  return Scene(files);
}

/// Arguments of an action: each a name, or several to choose from.
std::vector<std::vector<std::string>> ChoicesOf(const py::args& arguments) {
  std::vector<std::vector<std::string>> choices;
  for (const py::handle& argument : arguments) {
    if (py::isinstance<py::str>(argument)) {
      choices.push_back({argument.cast<std::string>()});
    } else {
      choices.push_back(argument.cast<std::vector<std::string>>());
    }
  }
  return choices;
}

Answer Imagine(const Scene& scene, const std::string& action, const py::args& arguments,
               const StartOfAction& start, const Request& request) {
  const hires::base::ActionTemplate choices{action, ChoicesOf(arguments)};
  return PlayUnlocked(
      [&](const auto& cancelled) { return scene.Imagine(start, choices, request, cancelled); });
}

RolloutRecording Record(const Scene& scene, const std::string& action, const py::args& arguments,
                        const StartOfAction& start, int rollout, std::uint64_t seed) {
  hires::base::ActionCall call{action, arguments.cast<std::vector<std::string>>()};
  return PlayUnlocked([&](const auto& cancelled) {
           return scene.Record(start, call, rollout, seed, cancelled);
         })
      .value();
}

constexpr char kImagineHelp[] =
    "Plays an action many times, and ranks the ways to do it. Each argument is a name, or a list "
    "of names\n"
    "to choose from; all combinations are played. robot_at: the area where the robot stands; "
    "on_tray:\n"
    "objects, each by its name or its file; facts: what else holds, 'Holding(rightArm1, mug1)'; "
    "put: {object: (x, y, z, yaw)} in "
    "the map\n"
    "[m, rad]. Zeros and '' stand for what the configuration says; threads=0: one per core. Same "
    "seed,\n"
    "same bits, for any number of threads, and the same as `hires imagine --local`.\n"
    "Raises ConfigError, which says what is wrong and what to do.";

using Poses = std::map<std::string, std::array<double, 4>>;

void BindScene(py::module_* m) {
  py::class_<Scene>(*m, "Scene", "World, robot and objects, loaded once for many requests.")
      .def(py::init(&MakeScene), py::kw_only(), "world"_a = "", "map"_a = "", "robot"_a = "",
           "objects"_a = std::vector<std::string>(), "catalogue"_a = "", "areas"_a = AreasByName(),
           "uncertainty"_a = "", "actions"_a = std::vector<std::string>(), "config"_a = "",
           "Files: world (SDF) or map (map_server YAML), robot (profile or URDF), objects (models "
           "beside\n"
           "those of the catalogue), uncertainty ('none': nothing is uncertain), actions "
           "(libraries).\n"
           "areas: {name: (x, y, yaw)} [m, rad], or a YAML file of goals. What is not named is as "
           "in the package's "
           "configuration.")
      .def_property_readonly("areas", &Scene::Areas, "Where the robot can stand.")
      .def_property_readonly("objects", &Scene::Objects, "What can be put somewhere.")
      .def_property_readonly("motion_sets", &Scene::MotionSets,
                             "{name: (speed [m/s], acceleration [m/s^2])}")
      .def("add_motion_set", &Scene::AddMotionSet, "name"_a, py::kw_only(), "speed"_a,
           "acceleration"_a, "turn_speed"_a = 1.0, "turn_acceleration"_a = 2.0,
           "One more way to drive: limits in [m/s], [m/s^2], [rad/s], [rad/s^2].")
      .def(
          "imagine",
          [](const Scene& scene, const std::string& action, const py::args& arguments,
             const std::string& robot_at, const std::vector<std::string>& on_tray,
             const std::vector<std::string>& facts, const Poses& put, int rollouts,
             std::uint64_t seed, int threads, double deadline, const std::string& ranking,
             double min_success, bool early_stop, double max_regret) {
            return Imagine(
                scene, action, arguments, {robot_at, on_tray, facts, put},
                {rollouts, seed, threads, deadline, ranking, min_success, early_stop, max_regret});
          },
          "action"_a, "robot_at"_a, "on_tray"_a = std::vector<std::string>(),
          "facts"_a = std::vector<std::string>(), "put"_a = Poses(), "rollouts"_a = 0, "seed"_a = 1,
          "threads"_a = 0, "deadline"_a = 0.0, "ranking"_a = "", "min_success"_a = 0.0,
          "early_stop"_a = true, "max_regret"_a = 0.0, kImagineHelp)
      .def(
          "record",
          [](const Scene& scene, const std::string& action, const py::args& arguments,
             const std::string& robot_at, const std::vector<std::string>& on_tray,
             const std::vector<std::string>& facts, const Poses& put, int rollout,
             std::uint64_t seed) {
            return Record(scene, action, arguments, {robot_at, on_tray, facts, put}, rollout, seed);
          },
          "action"_a, "robot_at"_a, "on_tray"_a = std::vector<std::string>(),
          "facts"_a = std::vector<std::string>(), "put"_a = Poses(), "rollout"_a = 0, "seed"_a = 1,
          "Plays one rollout and notes everything: rollout number `rollout` of `imagine` with that "
          "seed.");
}

}  // namespace

PYBIND11_MODULE(core, m) {
  m.doc() = "The ROS-free part of HIRES in this process: no master, no node.";
  m.attr("__version__") = HIRES_VERSION;
  py::register_exception<hires::base::ConfigError>(m, "ConfigError", PyExc_ValueError);
  BindAlternative(&m);
  BindAnswer(&m);
  BindRecording(&m);
  BindScene(&m);
  hires::python::NameWrongArguments(m.attr("Scene"),
                                    {"__init__", "add_motion_set", "imagine", "record"});
}
