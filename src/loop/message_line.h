#pragma once

#include <functional>

#include "hires/base/param_reader.h"
#include "hires/base/rng.h"
#include "loop/virtual_clock.h"

namespace hires::loop {

/// How messages of one kind fare on their way.
struct MessageParams {
  double delay{0.01};  ///< [s] each takes at least
  double jitter{0.0};  ///< [s] and by chance so much longer, evenly spread
  double loss{0.0};    ///< share of them that never arrives
};

/// @param may_lose  kinds that nobody asks for again have no `loss`.
/// @throws base::ConfigError naming file and key.
MessageParams ReadMessageParams(base::ParamReader in, bool may_lose);

/// What messages of one kind take from one part to another. None overtakes another, as on a
/// connection.
class MessageLine {
 public:
  /// @param rng  decides about jitter and loss.  @pre `clock` outlives this.
  MessageLine(const MessageParams& params, base::Rng rng, VirtualClock* clock);

  /// @param deliver  called when the message arrives, if it does.
  void Send(std::function<void()> deliver);

  int num_lost() const { return num_lost_; }

 private:
  const MessageParams params_;
  base::Rng rng_;
  VirtualClock& clock_;
  double arrived_{0.0};  // [s] when the last one does
  int num_lost_{0};
};

}  // namespace hires::loop
