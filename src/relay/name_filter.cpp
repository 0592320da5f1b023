#include "hires/relay/name_filter.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"

namespace hires::relay {
namespace {

constexpr std::size_t kLongestPattern = 256;
constexpr std::size_t kLongestName = 512;

bool IsPlainName(const std::string& pattern) {
  return std::all_of(pattern.begin(), pattern.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '/' || c == '_';
  });
}

std::regex Compile(const std::string& pattern, const std::string& where) {
  try {
    return std::regex(pattern, std::regex::ECMAScript | std::regex::optimize);
  } catch (const std::regex_error& error) {
    throw base::ConfigError(fmt::format(
        "{}: '{}' is no regular expression ({}); write a name such as /worker_1/scan or an "
        "expression such as /worker_1/.*",
        where, pattern, error.what()));
  }
}

}  // namespace

bool IsPrivateToMaster(const std::string& name) {
  return name == "/clock" || name == "/tf" || name == "/tf_static" || name == "/rosout" ||
         name == "/rosout_agg";
}

NameFilter::NameFilter(const std::vector<std::string>& patterns, const std::string& where) {
  for (const std::string& pattern : patterns) AddPattern(pattern, where);
}

void NameFilter::AddPattern(const std::string& pattern, const std::string& where) {
  if (pattern.empty() || pattern.front() != '/') {
    throw base::ConfigError(
        fmt::format("{}: '{}' is not absolute; names that cross between masters begin with '/'",
                    where, pattern));
  }
  if (pattern.size() > kLongestPattern) {
    throw base::ConfigError(fmt::format("{}: '{}...' has {} characters, at most {} are taken",
                                        where, pattern.substr(0, 32), pattern.size(),
                                        kLongestPattern));
  }
  if (IsPlainName(pattern)) {
    names_.insert(pattern);
  } else {
    expressions_.push_back(Compile(pattern, where));
  }
}

bool NameFilter::Matches(const std::string& name) const {
  if (names_.count(name) > 0) return true;
  if (IsPrivateToMaster(name) || name.size() > kLongestName) return false;
  return std::any_of(expressions_.begin(), expressions_.end(),
                     [&](const std::regex& e) { return std::regex_match(name, e); });
}

void NameFilter::Add(const NameFilter& other) {
  names_.insert(other.names_.begin(), other.names_.end());
  expressions_.insert(expressions_.end(), other.expressions_.begin(), other.expressions_.end());
}

}  // namespace hires::relay
