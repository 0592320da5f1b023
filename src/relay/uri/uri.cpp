#include "hires/relay/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::relay {
namespace {

bool TakePrefix(std::string_view prefix, std::string_view* text) {
  if (text->substr(0, prefix.size()) != prefix) return false;
  text->remove_prefix(prefix.size());
  return true;
}

std::optional<int> ParsePort(std::string_view digits) {
  int port = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, port);
  if (error != std::errc() || stop != end || port < 1 || port > 65535) return std::nullopt;
  return port;
}

bool IsHostCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_' ||
         c == ':' || c == '%';
}

/// "host" or "[v6]"; empty if it is neither.
std::string PlainHost(std::string_view host) {
  const bool has_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (has_brackets) host = host.substr(1, host.size() - 2);
  const bool has_colon = host.find(':') != std::string_view::npos;
  if (has_colon != has_brackets) return "";
  if (!std::all_of(host.begin(), host.end(), IsHostCharacter)) return "";
  return std::string(host);
}

bool IsThisPlace(const std::string& host, const HostNames& this_host) {
  return IsLoopback(host) || this_host.count(base::ToLower(host)) > 0;
}

}  // namespace

std::optional<Endpoint> ParseUri(std::string_view uri) {
  if (!TakePrefix("http://", &uri) && !TakePrefix("rosrpc://", &uri)) return std::nullopt;
  if (!uri.empty() && uri.back() == '/') uri.remove_suffix(1);
  const auto colon = uri.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::string host = PlainHost(uri.substr(0, colon));
  const std::optional<int> port = ParsePort(uri.substr(colon + 1));
  if (host.empty() || !port) return std::nullopt;
  return Endpoint{host, *port};
}

Endpoint RequireMasterUri(const std::string& uri, const std::string& where) {
  const auto endpoint = ParseUri(uri);
  if (!endpoint || uri.rfind("http://", 0) != 0) {
    throw base::ConfigError(fmt::format(
        "{} is '{}', wanted the address of a ROS master like http://localhost:11411/", where, uri));
  }
  return *endpoint;
}

bool IsLoopback(const std::string& host) {
  const std::string name = base::ToLower(host);
  return name == "localhost" || name.rfind("127.", 0) == 0 || name == "::1";
}

bool IsSamePlace(const std::string& a, const std::string& b, const HostNames& this_host) {
  if (base::ToLower(a) == base::ToLower(b)) return true;
  return IsThisPlace(a, this_host) && IsThisPlace(b, this_host);
}

}  // namespace hires::relay
