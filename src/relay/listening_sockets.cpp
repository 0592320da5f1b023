#include "hires/relay/listening_sockets.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/relay/uri.h"

namespace hires::relay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAddressField = 1, kStateField = 3, kUidField = 7, kInodeField = 9;
constexpr char kListen[] = "0A";
constexpr std::size_t kMostText = 4u << 20;  // [bytes] of one file in /proc that is read

template <typename T>
bool ParseNumber(const std::string& text, int base, T* value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value, base);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// The kernel prints each group of four bytes as one number in this machine's byte order.
std::optional<std::string> AddressFromHex(const std::string& hex) {
  if (hex.size() != 8 && hex.size() != 32) return std::nullopt;
  std::array<unsigned char, 16> bytes{};
  for (std::size_t group = 0; group < hex.size() / 8; ++group) {
    std::uint32_t number = 0;
    if (!ParseNumber(hex.substr(8 * group, 8), 16, &number)) return std::nullopt;
    std::memcpy(bytes.data() + 4 * group, &number, sizeof(number));
  }
  std::array<char, INET6_ADDRSTRLEN> text{};
  inet_ntop(hex.size() == 8 ? AF_INET : AF_INET6, bytes.data(), text.data(), text.size());
  return text.data();
}

std::vector<std::string> WordsOf(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Nothing if the line is none of the file's.
std::optional<ListeningSocket> ParseLine(const std::vector<std::string>& words) {
  if (words.size() <= kInodeField) return std::nullopt;
  const std::vector<std::string> local = base::Split(words[kAddressField], ':');
  if (local.size() != 2 || local[1].size() != 4) return std::nullopt;
  ListeningSocket socket;
  const auto address = AddressFromHex(local[0]);
  if (!address || !ParseNumber(local[1], 16, &socket.port) ||
      !ParseNumber(words[kUidField], 10, &socket.uid) ||
      !ParseNumber(words[kInodeField], 10, &socket.inode)) {
    return std::nullopt;
  }
  socket.address = *address;
  return socket;
}

std::string ReadSome(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostText, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

std::vector<std::string> CommandLine(const fs::path& process) {
  std::string text = ReadSome(process / "cmdline");
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return base::Split(text, '\0');
}

std::string FileName(const std::string& path) { return fs::path(path).filename().string(); }

bool IsInterpreter(const std::string& name) {
  return name.rfind("python", 0) == 0 || name == "bash" || name == "sh" || name == "perl";
}

/// "rosmaster" of `python3 -u /usr/bin/rosmaster --core`.
std::string NameOf(const std::vector<std::string>& words) {
  const std::string program = FileName(words.front());
  if (!IsInterpreter(program)) return program;
  const auto script = std::find_if(words.begin() + 1, words.end(), [](const std::string& word) {
    return !word.empty() && word.front() != '-';
  });
  return script == words.end() ? program : FileName(*script);
}

/// Targets of all links in /proc/<pid>/fd; none where the process is somebody else's or gone.
std::vector<std::string> OpenFiles(const fs::path& process) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator it(process / "fd", error), end; !error && it != end;
       it.increment(error)) {
    std::error_code gone;
    const fs::path target = fs::read_symlink(it->path(), gone);
    if (!gone) files.push_back(target.string());
  }
  return files;
}

SocketOwner Describe(int pid, const fs::path& process, std::vector<std::string> open_files,
                     const std::string& log_folder) {
  const ProcessTraits traits{CommandLine(process), ReadSome(process / "maps"),
                             std::move(open_files)};
  return {pid, NameOf(traits.words), LooksLikeRos(traits, log_folder)};
}

}  // namespace

bool ListeningSocket::is_loopback() const {
  static const std::string kMapped = "::ffff:";
  const bool is_mapped = address.rfind(kMapped, 0) == 0;
  return IsLoopback(is_mapped ? address.substr(kMapped.size()) : address);
}

bool ListeningSocket::is_everywhere() const { return address == "0.0.0.0" || address == "::"; }

std::vector<ListeningSocket> ParseListeningSockets(const std::string& text,
                                                   const std::string& where) {
  std::vector<ListeningSocket> sockets;
  const std::vector<std::string> lines = base::Split(text, '\n');
  for (std::size_t i = 1; i < lines.size(); ++i) {  // the first line holds the heads
    const std::vector<std::string> words = WordsOf(lines[i]);
    if (words.empty()) continue;
    const auto socket = ParseLine(words);
    if (!socket) {
      throw base::ConfigError(fmt::format(
          "{}: line {} is '{}', wanted a socket as Linux lists them (address:port in hex, state, "
          "user, inode); is this another system?",
          where, i + 1, lines[i]));
    }
    if (words[kStateField] == kListen) sockets.push_back(*socket);
  }
  return sockets;
}

std::optional<std::uint64_t> SocketInodeOf(const std::string& link) {
  static const std::string kBegin = "socket:[";
  if (link.rfind(kBegin, 0) != 0 || link.back() != ']') return std::nullopt;
  std::uint64_t inode = 0;
  const std::string digits = link.substr(kBegin.size(), link.size() - kBegin.size() - 1);
  if (!ParseNumber(digits, 10, &inode)) return std::nullopt;
  return inode;
}

bool LooksLikeRos(const ProcessTraits& traits, const std::string& log_folder) {
  static const std::set<std::string> kTools{"roscore", "roslaunch", "rosmaster", "rosout"};
  const bool has_name =
      std::any_of(traits.words.begin(), traits.words.end(), [](const std::string& word) {
        return kTools.count(FileName(word)) > 0 || word.rfind("__name:=", 0) == 0 ||
               word.rfind("__log:=", 0) == 0;
      });
  const bool has_log =
      std::any_of(traits.open_files.begin(), traits.open_files.end(), [&](const std::string& file) {
        return !log_folder.empty() && file.rfind(log_folder + "/", 0) == 0;
      });
  return has_name || has_log || traits.maps.find("/libroscpp.so") != std::string::npos;
}

std::map<std::uint64_t, SocketOwner> FindSocketOwners(const std::vector<ListeningSocket>& sockets,
                                                      const std::string& proc,
                                                      const std::string& log_folder) {
  std::set<std::uint64_t> wanted;
  for (const ListeningSocket& socket : sockets) wanted.insert(socket.inode);
  std::map<std::uint64_t, SocketOwner> owners;
  std::error_code error;
  for (fs::directory_iterator it(proc, error), end; !error && it != end; it.increment(error)) {
    int pid = 0;
    if (!ParseNumber(it->path().filename().string(), 10, &pid)) continue;
    const std::vector<std::string> files = OpenFiles(it->path());
    for (const std::string& file : files) {
      const auto inode = SocketInodeOf(file);
      if (!inode || wanted.count(*inode) == 0 || owners.count(*inode) > 0) continue;
      owners[*inode] = Describe(pid, it->path(), files, log_folder);
    }
  }
  return owners;
}

}  // namespace hires::relay
