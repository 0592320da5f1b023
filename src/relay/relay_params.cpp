#include "hires/relay/relay_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "hires/relay/uri.h"

namespace hires::relay {
namespace {

constexpr char kPlaceholder[] = "{ns}";

bool IsAbsoluteName(const std::string& name) {
  static const std::regex form("(/[A-Za-z][A-Za-z0-9_]*)+");
  return name.size() <= 256 && std::regex_match(name, form);
}

base::Bound<std::string> AbsoluteName() {
  return {IsAbsoluteName, "an absolute name such as /worker_1, without a '/' at its end"};
}

base::Bound<std::string> EmptyOrAbsoluteName() {
  return {[](const std::string& name) { return name.empty() || IsAbsoluteName(name); },
          "empty, or an absolute name such as /worker_1, without a '/' at its end"};
}

std::string PutNamespace(std::string pattern, const std::string& key, const RelayParams& params,
                         const base::ParamReader& in) {
  for (auto at = pattern.find(kPlaceholder); at != std::string::npos;
       at = pattern.find(kPlaceholder)) {
    if (params.name_space.empty()) {
      in.Fail(key, fmt::format("'{}' needs a namespace; set `namespace` to what {{ns}} stands for",
                               pattern));
    }
    pattern.replace(at, sizeof(kPlaceholder) - 1, params.name_space);
  }
  return pattern;
}

NameFilter ReadFilter(const std::string& key, const RelayParams& params, base::ParamReader* in) {
  std::vector<std::string> patterns = in->GetStrings(key);
  if (patterns.size() > 1000) in->Fail(key, "wanted at most 1000 names");
  for (std::string& pattern : patterns) pattern = PutNamespace(pattern, key, params, *in);
  return NameFilter(patterns, key);
}

NameFilter TopicsBelow(const std::string& action, const std::vector<std::string>& parts) {
  std::vector<std::string> topics;
  for (const std::string& part : parts) topics.push_back(action + "/" + part);
  return NameFilter(topics, "actions");
}

/// The client publishes goal and cancel, the server the other three.
void AddAction(const std::string& action, Route* server, Route* client) {
  client->topics.Add(TopicsBelow(action, {"goal", "cancel"}));
  server->topics.Add(TopicsBelow(action, {"status", "feedback", "result"}));
}

void ReadAction(base::ParamReader in, RelayParams* params) {
  const std::string name = PutNamespace(in.GetString("name"), "name", *params, in);
  if (!IsAbsoluteName(name)) in.Fail("name", "wanted " + AbsoluteName().wanted);
  const bool is_foreign =
      in.Get("server", base::OneOf({"local", "foreign"})) == std::string("foreign");
  AddAction(name, is_foreign ? &params->foreign : &params->local,
            is_foreign ? &params->local : &params->foreign);
}

void ReadRoutes(base::ParamReader* in, RelayParams* params) {
  params->local.topics = ReadFilter("local_pubs", *params, in);
  params->foreign.topics = ReadFilter("foreign_pubs", *params, in);
  params->local.services = ReadFilter("local_services", *params, in);
  params->foreign.services = ReadFilter("foreign_services", *params, in);
  if (!in->Has("actions")) return;
  for (const base::ParamReader& action : in->SubList("actions")) ReadAction(action, params);
}

bool IsEmpty(const Route& route) { return route.topics.is_empty() && route.services.is_empty(); }

/// The file's value unless the node's own parameter says otherwise; both must fit.
std::string Choose(const std::string& key, const std::string& override_value,
                   const base::Bound<std::string>& bound, base::ParamReader* in) {
  const std::string from_file = in->Get(key, bound);
  if (override_value.empty()) return from_file;
  if (!bound.holds(override_value)) {
    in->Fail(key, fmt::format("and the node's ~{} is '{}', wanted {}", key, override_value,
                              bound.wanted));
  }
  return override_value;
}

}  // namespace

std::string TagOf(const std::string& name_space) {
  if (name_space.empty()) return "relay";
  std::string tag = name_space.substr(1);
  std::replace(tag.begin(), tag.end(), '/', '_');
  return tag;
}

RelayParams ReadRelayParams(base::ParamReader in, const RelayOverrides& overrides) {
  RelayParams params;
  const base::Bound<std::string> master_uri{
      [](const std::string& uri) {
        return uri.rfind("http://", 0) == 0 && ParseUri(uri).has_value();
      },
      "the address of a ROS master like http://localhost:11411/"};
  params.foreign_master = Choose("foreign_master", overrides.foreign_master, master_uri, &in);
  params.name_space = Choose("namespace", overrides.name_space, EmptyOrAbsoluteName(), &in);
  params.alias_prefix = in.Get("alias_prefix", AbsoluteName());
  params.poll_period = in.Get("poll_period", base::Between(0.01, 10.0));
  params.ping_period = in.Get("ping_period", base::Between(0.05, 60.0));
  params.call_timeout = in.Get("call_timeout", base::Between(0.05, 10.0));
  ReadRoutes(&in, &params);
  in.RejectUnknownKeys();
  if (IsEmpty(params.local) && IsEmpty(params.foreign)) {
    in.Fail("foreign_pubs",
            "and so are all other lists: nothing would cross; name a topic, a "
            "service or an action");
  }
  return params;
}

}  // namespace hires::relay
