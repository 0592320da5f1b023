#include "loop/message_line.h"

#include <algorithm>
#include <utility>

namespace hires::loop {

using base::Between;

MessageParams ReadMessageParams(base::ParamReader in, bool may_lose) {
  MessageParams params;
  params.delay = in.Get("delay", Between(0.0, 1.0));
  params.jitter = in.Get("jitter", Between(0.0, 1.0));
  if (may_lose) params.loss = in.Get("loss", Between(0.0, 0.9));
  in.RejectUnknownKeys();
  return params;
}

MessageLine::MessageLine(const MessageParams& params, base::Rng rng, VirtualClock* clock)
    : params_(params), rng_(rng), clock_(*clock) {}

void MessageLine::Send(std::function<void()> deliver) {
  if (params_.loss > 0.0 && rng_.Bernoulli(params_.loss)) {
    ++num_lost_;
    return;
  }
  const double delay = params_.delay + rng_.Uniform(0.0, params_.jitter);
  arrived_ = std::max(arrived_, clock_.now() + delay);
  clock_.At(arrived_, std::move(deliver));
}

}  // namespace hires::loop
