#pragma once

#include <map>
#include <string>

namespace hires::base {

/// Warnings about what comes on topics, at most one a second for each topic: a sensor that is wrong
/// is so many times a second.
class TopicWarnings {
 public:
  /// "topic=base_scan dropped why=no ranges"
  void Tell(const std::string& topic, const std::string& what, const std::string& why);

 private:
  std::map<std::string, double> told_;  // topic -> steady [s]
};

}  // namespace hires::base
