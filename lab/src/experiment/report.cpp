#include "lab/src/experiment/report.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "lab/src/interval_json.h"
#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;
using tinyxml2::XMLPrinter;
using Relation = Expectation::Relation;

struct RelationName {
  Relation relation;
  const char* key;
  const char* words;
};
constexpr RelationName kRelations[] = {{Relation::kAtLeast, "at_least", "at least"},
                                       {Relation::kAtMost, "at_most", "at most"},
                                       {Relation::kAbove, "above", "above"},
                                       {Relation::kBelow, "below", "below"}};

Expectation ReadExpectation(base::ParamReader in) {
  Expectation expectation;
  expectation.measure = in.GetString("measure");
  int num_relations = 0;
  for (const RelationName& name : kRelations) {
    if (!in.Has(name.key)) continue;
    ++num_relations;
    expectation.relation = name.relation;
    expectation.bound = in.Get(name.key, base::Between(-1e9, 1e9));
  }
  if (num_relations != 1) {
    in.Fail("measure", "wanted with it exactly one of at_least, at_most, above, below");
  }
  return expectation;
}

std::string CsvField(const ordered_json& value) {
  if (!value.is_string()) return value.is_null() ? "" : value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

ordered_json IntervalsToJson(const std::vector<NamedInterval>& intervals) {
  ordered_json json = ordered_json::object();
  for (const auto& [name, interval] : intervals) {
    json[name] = IntervalJson(interval);
  }
  return json;
}

/// Those that the report shows; what stands in them is for people.
ordered_json TablesToJson(const std::vector<TextTable>& tables) {
  ordered_json list = ordered_json::array();
  for (const TextTable& table : tables) {
    if (table.rows.size() < 2) continue;
    list.push_back({{"title", table.title},
                    {"heads", table.rows.front()},
                    {"rows", std::vector(table.rows.begin() + 1, table.rows.end())}});
  }
  return list;
}

TextTable ChecksTable(const ExperimentReport& report) {
  TextTable table{"Expectations", {{"", "expected", "found"}}};
  for (const CheckedExpectation& check : report.checks) {
    table.rows.push_back({check.holds ? "ok" : "FAILED", ToString(check.expectation),
                          fmt::format("{:.5g}", check.value)});
  }
  return table;
}

int NumFailed(const ExperimentReport& report) {
  return static_cast<int>(std::count_if(report.checks.begin(), report.checks.end(),
                                        [](const auto& check) { return !check.holds; }));
}

void PushCounts(const ExperimentReport& report, XMLPrinter* xml) {
  xml->PushAttribute("tests", static_cast<int>(report.checks.size()));
  xml->PushAttribute("failures", NumFailed(report));
  xml->PushAttribute("errors", 0);
  xml->PushAttribute("time", fmt::format("{:.3f}", report.wall_seconds).c_str());
}

void AddProperty(const char* name, const std::string& value, XMLPrinter* xml) {
  xml->OpenElement("property");
  xml->PushAttribute("name", name);
  xml->PushAttribute("value", value.c_str());
  xml->CloseElement();
}

void AddProperties(const ExperimentReport& report, XMLPrinter* xml) {
  xml->OpenElement("properties");
  AddProperty("kind", report.kind, xml);
  AddProperty("seed", std::to_string(report.seed), xml);
  AddProperty("experiment", base::HexOf(report.experiment_hash), xml);
  AddProperty("parameters", base::HexOf(report.params_hash), xml);
  xml->CloseElement();
}

void AddCase(const ExperimentReport& report, const CheckedExpectation& check, XMLPrinter* xml) {
  xml->OpenElement("testcase");
  xml->PushAttribute("classname", ("hires." + report.name).c_str());
  xml->PushAttribute("name", ToString(check.expectation).c_str());
  xml->PushAttribute("time", "0");  // all of them come from the same play
  if (!check.holds) {
    const std::string found =
        std::isfinite(check.value) ? fmt::format("{:.17g}", check.value) : "no number";
    const std::string message =
        fmt::format("wanted {}, found {}", ToString(check.expectation), found);
    xml->OpenElement("failure");
    xml->PushAttribute("type", "expectation");
    xml->PushAttribute("message", message.c_str());
    xml->CloseElement();
  }
  xml->CloseElement();
}

}  // namespace

bool Expectation::HoldsFor(double value) const {
  switch (relation) {
    case Relation::kAtLeast:
      return value >= bound;
    case Relation::kAtMost:
      return value <= bound;
    case Relation::kAbove:
      return value > bound;
    case Relation::kBelow:
      return value < bound;
  }
  return false;
}

std::string ToString(const Expectation& expectation) {
  for (const RelationName& name : kRelations) {
    if (name.relation != expectation.relation) continue;
    return fmt::format("{} {} {:g}", expectation.measure, name.words, expectation.bound);
  }
  return expectation.measure;
}

std::vector<Expectation> ReadExpectations(base::ParamReader* in) {
  std::vector<Expectation> expectations;
  for (base::ParamReader& entry : in->SubList("expect")) {
    expectations.push_back(ReadExpectation(entry));
  }
  return expectations;
}

bool ExperimentReport::passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const auto& check) { return check.holds; });
}

std::vector<CheckedExpectation> CheckExpectations(const std::vector<Expectation>& expectations,
                                                  const std::vector<Measure>& measures) {
  std::vector<CheckedExpectation> checks;
  for (const Expectation& expectation : expectations) {
    const auto found = std::find_if(measures.begin(), measures.end(), [&](const Measure& measure) {
      return measure.name == expectation.measure;
    });
    if (found == measures.end()) {
      std::vector<std::string> names;
      for (const Measure& measure : measures) names.push_back(measure.name);
      throw base::ConfigError("expect: " +
                              base::UnknownName("measure", expectation.measure, names));
    }
    checks.push_back({expectation, found->value, expectation.HoldsFor(found->value)});
  }
  return checks;
}

std::string HeadText(const ExperimentReport& report) {
  return fmt::format("{} ({}), seed {}, parameters {}, experiment {}\n", report.name, report.kind,
                     report.seed, base::HexOf(report.params_hash),
                     base::HexOf(report.experiment_hash));
}

std::string ReportText(const ExperimentReport& report) {
  std::string text = HeadText(report);
  for (const TextTable& table : report.findings.tables) {
    if (table.rows.size() < 2) continue;
    text += '\n' + table.title + '\n' + reports::FormatTable(table.rows);
  }
  if (!report.checks.empty()) {
    const TextTable checks = ChecksTable(report);
    text += '\n' + checks.title + '\n' + reports::FormatTable(checks.rows);
  }
  return text;
}

std::string ReportCsv(const ExperimentReport& report) {
  std::string text;
  for (const ordered_json& row : report.findings.rows) {
    std::vector<std::string> heads, fields;
    for (const auto& [key, value] : row.items()) {
      heads.push_back(key);
      fields.push_back(CsvField(value));
    }
    if (text.empty()) text = base::Join(heads, ",") + '\n';
    text += base::Join(fields, ",") + '\n';
  }
  return text;
}

ordered_json ToJson(const ExperimentReport& report) {
  ordered_json measures = ordered_json::object(), checks = ordered_json::array();
  for (const Measure& measure : report.findings.measures) {
    measures[measure.name] = reports::NumberOrNull(measure.value);
  }
  for (const CheckedExpectation& check : report.checks) {
    checks.push_back({{"expected", ToString(check.expectation)},
                      {"measure", check.expectation.measure},
                      {"bound", reports::NumberOrNull(check.expectation.bound)},
                      {"found", reports::NumberOrNull(check.value)},
                      {"holds", check.holds}});
  }
  return {{"name", report.name},
          {"kind", report.kind},
          {"seed", report.seed},
          {"experiment", base::HexOf(report.experiment_hash)},
          {"parameters", base::HexOf(report.params_hash)},
          {"passed", report.passed()},
          {"measures", measures},
          {"intervals", IntervalsToJson(report.findings.intervals)},
          {"expectations", checks},
          {"tables", TablesToJson(report.findings.tables)},
          {"rows", report.findings.rows},
          {"simulated_seconds", report.findings.simulated_seconds},
          {"wall_seconds", report.wall_seconds}};
}

std::string JunitXml(const ExperimentReport& report) {
  XMLPrinter xml;
  xml.PushHeader(false, true);
  xml.OpenElement("testsuites");
  PushCounts(report, &xml);
  xml.OpenElement("testsuite");
  xml.PushAttribute("name", report.name.c_str());
  PushCounts(report, &xml);
  AddProperties(report, &xml);
  for (const CheckedExpectation& check : report.checks) AddCase(report, check, &xml);
  xml.CloseElement();
  xml.CloseElement();
  return std::string(xml.CStr()) + '\n';
}

}  // namespace hires::lab
