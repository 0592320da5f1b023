#pragma once

#include <map>
#include <string>

namespace hires::base {

/// Warnings about what comes on topics: a sensor that is wrong is so many times a second. At most
/// one a second for each topic; what is said again, but for its numbers, comes after pauses that
/// double, and at once where it had been well for a while.
class TopicWarnings {
 public:
  /// "topic=base_scan dropped why=no ranges"
  void Tell(const std::string& topic, const std::string& what, const std::string& why);
  void Tell(const std::string& topic, const std::string& what, const std::string& why,
            double now);  ///< [s] steady

 private:
  struct Reason {
    double heard{0.0}, due{0.0};  // [s] for the last time, to be told not before
    double pause{1.0};            // [s] after it is told
  };
  struct Topic {
    double free{0.0};                       // [s] nothing is told before
    std::map<std::string, Reason> reasons;  // by their words
  };

  std::map<std::string, Topic> topics_;
};

}  // namespace hires::base
