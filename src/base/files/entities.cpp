#include "base/files/entities.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

constexpr char kDeclaration[] = "<!ENTITY";
constexpr char kBlank[] = " \t\r\n";
constexpr std::size_t kMostNamed = 5;

/// Those that stand for text; parameter entities ("% name") stand for declarations alone.
std::set<std::string> DeclaredIn(const std::string& xml) {
  std::set<std::string> names;
  for (std::size_t at = xml.find(kDeclaration); at != std::string::npos;
       at = xml.find(kDeclaration, at)) {
    at += sizeof(kDeclaration) - 1;
    const std::size_t begin = xml.find_first_not_of(kBlank, at);
    if (begin == std::string::npos || xml[begin] == '%') continue;
    names.insert(xml.substr(begin, xml.find_first_of(kBlank, begin) - begin));
  }
  return names;
}

}  // namespace

void RefuseEntities(const std::string& xml, const std::string& path) {
  const std::set<std::string> declared = DeclaredIn(xml);
  if (declared.empty()) return;
  std::set<std::string> used;
  std::size_t first = std::string::npos;
  for (std::size_t at = xml.find("]>"); at < xml.size(); at = xml.find('&', at + 1)) {
    if (xml[at] != '&') continue;
    const std::size_t end = xml.find_first_of("; \t\r\n<>&", at + 1);
    const std::string name = xml.substr(at + 1, end - at - 1);
    if (declared.count(name) == 0) continue;
    first = std::min(first, at);
    used.insert("&" + name + ";");
  }
  if (used.empty()) return;
  std::vector<std::string> named(used.begin(), used.end());
  if (named.size() > kMostNamed) {
    named.resize(kMostNamed);
    named.push_back(fmt::format("{} more", used.size() - kMostNamed));
  }
  throw ConfigError(fmt::format(
      "{}:{}: uses entities that it declares ({}), which are not put in; write their text, as "
      "`xmllint --noent` does",
      path, 1 + std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(first), '\n'),
      Join(named, ", ")));
}

}  // namespace hires::base
