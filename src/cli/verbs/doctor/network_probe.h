#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "hires/relay/uri.h"

/// Single questions of `hires doctor --robot` to other programs over the network. Each ends within
/// its time limit, whatever the other side does, and none changes anything there.
namespace hires::cli {

/// IPv4 addresses of a host name, in order; none if it is unknown here. An address is its own.
std::vector<std::string> AddressesOf(const std::string& host);

/// How a port of another program answers.
enum class Reach {
  kAnswers,
  kRefused,       ///< its computer says that no program listens there
  kSilent,        ///< no answer in time: a firewall, or its computer is off or cut off
  kUnresolvable,  ///< its host name is unknown here
  kBadUri         ///< its address cannot be read
};

/// Connects and hangs up.
/// @param timeout  [s]
Reach ProbePort(const hires::relay::Endpoint& port, double timeout);

/// How far the clock of another computer is ahead of this one's: between `lower` and `upper` [s].
struct ClockBounds {
  double lower{-1e9};
  double upper{1e9};
  int num_answers{0};  ///< that the bounds rest on

  double width() const { return upper - lower; }
  /// Narrows the bounds by one answer: its clock stood between `earliest` and `latest` [s] at some
  /// moment between `sent` and `received` [s] of this computer's.
  void Add(double sent, double received, double earliest, double latest);
};

/// Seconds since 1970 of an HTTP date like "Fri, 20 Nov 2026 14:36:22 GMT"; nothing for others.
std::optional<double> ParseHttpDate(const std::string& text);

/// Asks a Python node or master, whose HTTP answers tell the second, again and again until the
/// second changes: where it does, both clocks can be compared to within one round trip.
/// @param wanted   [s] width of the bounds that is good enough.
/// @param timeout  [s] for all questions together; 1.2 s are enough for any phase of the second.
/// @return Nothing if it does not answer or tells no time, as roscpp nodes.
std::optional<ClockBounds> CompareClocks(const hires::relay::Endpoint& server, double wanted,
                                         double timeout);

/// This computer's address on the way to another one; nothing if there is no way.
std::optional<std::string> OwnAddressTowards(const hires::relay::Endpoint& other);

}  // namespace hires::cli
