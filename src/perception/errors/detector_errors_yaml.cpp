#include <fmt/format.h>

#include <cmath>

#include "hires/base/param_reader.h"
#include "hires/perception/detector_errors.h"

namespace hires::perception {
namespace {

using base::Between;
using base::ParamReader;

constexpr double kLargest = 1e3;  // of weights, whose regressors are about 1

Regression ReadRegression(ParamReader in) {
  Regression out;
  for (std::size_t i = 0; i < kRegressorNames.size(); ++i) {
    const std::vector<double> pair = in.GetNumbers(kRegressorNames[i], 2);
    const auto at = static_cast<Eigen::Index>(i);
    out.weight[at] = pair[0];
    out.error[at] = pair[1];
    if (std::abs(pair[0]) > kLargest || !(pair[1] >= 0.0 && pair[1] <= kLargest)) {
      in.Fail(kRegressorNames[i],
              fmt::format("namely [{:g}, {:g}], wanted a weight and its standard error, each of at "
                          "most {:g}, the error not below 0",
                          pair[0], pair[1], kLargest));
    }
  }
  out.repeats = in.Get("repeats", Between(0.0, 1.0));
  return out;
}

LengthRegression ReadLength(ParamReader in) {
  LengthRegression out;
  out.spread = in.Get("spread", Between(0.0, 5.0));
  out.log = ReadRegression(in);
  return out;
}

std::map<std::string, std::map<std::string, int>> ReadCalled(ParamReader in) {
  std::map<std::string, std::map<std::string, int>> called;
  for (const std::string& kind : in.Keys()) {
    ParamReader names = in.Sub(kind);
    for (const std::string& name : names.Keys())
      called[kind][name] = names.Get(name, Between(1, 1000000000));
  }
  return called;
}

std::string RegressionText(const Regression& one) {
  std::string text;
  for (std::size_t i = 0; i < kRegressorNames.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    text +=
        fmt::format("  {}: [{:.4f}, {:.4f}]\n", kRegressorNames[i], one.weight[at], one.error[at]);
  }
  return text + fmt::format("  repeats: {:.4f}\n", one.repeats);
}

std::string LengthText(const LengthRegression& one) {
  return RegressionText(one.log) + fmt::format("  spread: {:.4f}\n", one.spread);
}

}  // namespace

DetectorErrors ReadDetectorErrors(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  DetectorErrors out;
  out.found = ReadRegression(in.Sub("found"));
  out.named = ReadRegression(in.Sub("named"));
  out.called = ReadCalled(in.Sub("called"));
  ParamReader mistaken = in.Sub("mistaken");
  out.confidence = mistaken.Get("confidence", Between(0.001, 1.0));
  out.doubt = mistaken.Get("doubt", Between(0.0, 1.0));
  out.position = ReadLength(in.Sub("position"));
  const std::vector<double> direction = in.GetNumbers("direction", 3);
  out.direction = Eigen::Map<const Eigen::Vector3d>(direction.data());
  if (out.direction.minCoeff() < 0.0 || std::abs(out.direction.sum() - 1.0) > 1e-3) {
    in.Fail("direction",
            fmt::format("namely [{:g}, {:g}, {:g}], wanted three shares with the sum 1",
                        direction[0], direction[1], direction[2]));
  }
  out.turn = ReadLength(in.Sub("turn"));
  in.RejectUnknownKeys();
  return out;
}

std::string ToYaml(const DetectorErrors& errors) {
  std::string called;
  for (const auto& [kind, names] : errors.called) {
    std::string list;
    for (const auto& [name, number] : names)
      list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", name, number);
    called += fmt::format("  {}: {{{}}}\n", kind, list);
  }
  return fmt::format(
      "found:                         # log odds: [weight, its standard error]\n{}"
      "named:                         # log odds that what is found is called rightly\n{}"
      "called:{}\n{}"
      "mistaken: {{confidence: {:.4f}, doubt: {:.4f}}}  # in the wrong name; in what it is\n"
      "position:                      # logarithm of [m]\n{}"
      "direction: [{:.4f}, {:.4f}, {:.4f}]  # variances of its direction: away, across, up\n"
      "turn:                          # logarithm of [rad]\n{}",
      RegressionText(errors.found), RegressionText(errors.named), called.empty() ? " {}" : "",
      called, errors.confidence, errors.doubt, LengthText(errors.position), errors.direction.x(),
      errors.direction.y(),
      1.0 - std::stod(fmt::format("{:.4f}", errors.direction.x())) -
          std::stod(fmt::format("{:.4f}", errors.direction.y())),
      LengthText(errors.turn));
}

}  // namespace hires::perception
