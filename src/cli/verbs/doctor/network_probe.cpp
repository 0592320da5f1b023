#include "cli/verbs/doctor/network_probe.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <set>

#include "hires/base/process.h"
#include "hires/base/text.h"

namespace hires::cli {
namespace {

using hires::relay::Endpoint;

constexpr std::size_t kLongestAnswer = 16384;     // [bytes] heads of an answer are far shorter
constexpr double kPauseBetweenQuestions = 0.003;  // [s]
constexpr double kSecond = 1.0;                   // [s] resolution of an HTTP date

/// [s] since 1970 by this computer's clock.
double WallNow() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A TCP connection that never blocks longer than it is told.
class Connection {
 public:
  Connection() = default;
  ~Connection() {
    if (fd_ >= 0) close(fd_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Reach Open(const sockaddr_in& address, double end) {
    fd_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd_ < 0) return Reach::kSilent;
    if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
      return Reach::kAnswers;
    }
    if (errno == ECONNREFUSED) return Reach::kRefused;
    if (errno != EINPROGRESS || !Await(POLLOUT, end)) return Reach::kSilent;
    int error = 0;
    socklen_t size = sizeof(error);
    getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error == 0) return Reach::kAnswers;
    return error == ECONNREFUSED ? Reach::kRefused : Reach::kSilent;
  }

  bool Send(const std::string& text) {
    return send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }

  /// What comes up to the end of an HTTP answer's heads.
  std::string ReceiveHeads(double end) {
    std::string text;
    std::array<char, 2048> buffer{};
    while (text.find("\r\n\r\n") == std::string::npos && text.size() < kLongestAnswer) {
      if (!Await(POLLIN, end)) break;
      const ssize_t size = recv(fd_, buffer.data(), buffer.size(), 0);
      if (size <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return text;
  }

 private:
  bool Await(short event, double end) {
    pollfd waiting{fd_, event, 0};
    const double left = end - hires::base::SteadyNow();
    return left > 0.0 && poll(&waiting, 1, static_cast<int>(std::ceil(left * 1e3))) > 0;
  }

  int fd_{-1};
};

std::optional<sockaddr_in> SocketAddress(const Endpoint& port) {
  const std::vector<std::string> addresses = AddressesOf(port.host);
  if (addresses.empty()) return std::nullopt;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port.port));
  inet_pton(AF_INET, addresses.front().c_str(), &address.sin_addr);
  return address;
}

std::string PidQuestion(const Endpoint& server) {
  const std::string body =
      "<?xml version=\"1.0\"?><methodCall><methodName>getPid</methodName><params><param><value>"
      "<string>/hires_doctor</string></value></param></params></methodCall>";
  return fmt::format(
      "POST /RPC2 HTTP/1.0\r\nHost: {}:{}\r\nContent-Type: text/xml\r\nContent-Length: {}\r\n\r\n"
      "{}",
      server.host, server.port, body.size(), body);
}

/// The head's text after "Date:", or nothing.
std::optional<std::string> DateOf(const std::string& heads) {
  for (const std::string& line : hires::base::Split(heads, '\n')) {
    if (hires::base::ToLower(line.substr(0, 5)) != "date:") continue;
    const auto begin = line.find_first_not_of(' ', 5);
    const auto end = line.find_last_not_of("\r ");
    if (begin != std::string::npos && end >= begin) return line.substr(begin, end + 1 - begin);
  }
  return std::nullopt;
}

/// One question and answer.  @return False if the other side tells no time.
bool AskTime(const Endpoint& server, const sockaddr_in& address, double end, ClockBounds* bounds) {
  Connection connection;
  if (connection.Open(address, end) != Reach::kAnswers) return false;
  const double sent = WallNow();
  if (!connection.Send(PidQuestion(server))) return false;
  const std::string heads = connection.ReceiveHeads(end);
  const double received = WallNow();
  const auto date = DateOf(heads);
  const auto second = date ? ParseHttpDate(*date) : std::nullopt;
  if (!second) return false;
  bounds->Add(sent, received, *second, *second + kSecond);
  return true;
}

}  // namespace

std::vector<std::string> AddressesOf(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;  // as roscpp, unless ROS_IPV6 says otherwise
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) return {};
  std::set<std::string> addresses;
  for (const addrinfo* it = found; it != nullptr; it = it->ai_next) {
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(it->ai_addr);
    inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    addresses.insert(text.data());
  }
  freeaddrinfo(found);
  return {addresses.begin(), addresses.end()};
}

Reach ProbePort(const Endpoint& port, double timeout) {
  const auto address = SocketAddress(port);
  if (!address) return Reach::kUnresolvable;
  return Connection().Open(*address, hires::base::SteadyNow() + timeout);
}

void ClockBounds::Add(double sent, double received, double earliest, double latest) {
  lower = std::max(lower, earliest - received);
  upper = std::min(upper, latest - sent);
  ++num_answers;
}

std::optional<double> ParseHttpDate(const std::string& text) {
  std::tm time{};
  const char* end = strptime(text.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &time);
  if (end == nullptr || *end != '\0') return std::nullopt;
  return static_cast<double>(timegm(&time));
}

std::optional<ClockBounds> CompareClocks(const Endpoint& server, double wanted, double timeout) {
  const auto address = SocketAddress(server);
  if (!address) return std::nullopt;
  const double end = hires::base::SteadyNow() + timeout;
  ClockBounds bounds;
  while (bounds.width() > wanted && hires::base::SteadyNow() < end) {
    if (!AskTime(server, *address, end, &bounds)) break;
    timespec pause{0, static_cast<long>(kPauseBetweenQuestions * 1e9)};
    nanosleep(&pause, nullptr);
  }
  if (bounds.num_answers == 0) return std::nullopt;
  return bounds;
}

std::optional<std::string> OwnAddressTowards(const Endpoint& other) {
  const auto address = SocketAddress(other);
  if (!address) return std::nullopt;
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);  // connecting it sends nothing
  if (fd < 0) return std::nullopt;
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  const bool has_way =
      connect(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof(*address)) == 0 &&
      getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) == 0;
  close(fd);
  if (!has_way) return std::nullopt;
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &own.sin_addr, text.data(), text.size());
  return text.data();
}

}  // namespace hires::cli
