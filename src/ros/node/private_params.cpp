#include "hires/ros/node/private_params.h"

#include <ros/param.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <sstream>

#include "hires/base/text.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using XmlRpc::XmlRpcValue;

std::optional<XmlRpcValue> PrivateValue(const std::string& key) {
  XmlRpcValue value;
  if (!ros::param::get("~" + key, value)) return std::nullopt;
  return value;
}

[[noreturn]] void Fail(const std::string& key, XmlRpcValue value, const std::string& wanted) {
  std::ostringstream text;
  if (value.getType() == XmlRpcValue::TypeBoolean) {
    text << std::boolalpha << static_cast<bool>(value);  // the library would write 1
  } else if (value.getType() == XmlRpcValue::TypeString) {
    text << '\'' << static_cast<std::string>(value) << '\'';
  } else {
    value.write(text);
  }
  throw ConfigError(fmt::format("~{} is {}, wanted {}", key, text.str(), wanted));
}

}  // namespace

std::optional<std::string> PrivateText(const std::string& key) {
  auto value = PrivateValue(key);
  if (!value) return std::nullopt;
  if (value->getType() != XmlRpcValue::TypeString) Fail(key, *value, "text");
  return static_cast<std::string>(*value);
}

std::optional<std::string> PrivateWord(const std::string& key,
                                       const hires::base::Bound<std::string>& bound) {
  auto value = PrivateValue(key);
  if (!value) return std::nullopt;
  std::optional<std::string> word;
  if (value->getType() == XmlRpcValue::TypeString) {
    word = static_cast<std::string>(*value);
    if (word->empty()) return std::nullopt;
  } else if (value->getType() == XmlRpcValue::TypeBoolean) {
    word = hires::base::WordOf(static_cast<bool>(*value), bound);
  }
  if (!word || !bound.holds(*word)) Fail(key, *value, bound.wanted);
  return word;
}

std::optional<int> PrivateInt(const std::string& key) {
  auto value = PrivateValue(key);
  if (!value) return std::nullopt;
  if (value->getType() != XmlRpcValue::TypeInt) Fail(key, *value, "a whole number");
  return static_cast<int>(*value);
}

std::optional<double> PrivateNumber(const std::string& key) {
  auto value = PrivateValue(key);
  if (!value) return std::nullopt;
  if (value->getType() == XmlRpcValue::TypeInt) return static_cast<int>(*value);
  if (value->getType() != XmlRpcValue::TypeDouble) Fail(key, *value, "a number");
  return static_cast<double>(*value);
}

std::optional<bool> PrivateBool(const std::string& key) {
  auto value = PrivateValue(key);
  if (!value) return std::nullopt;
  if (value->getType() != XmlRpcValue::TypeBoolean) Fail(key, *value, "true or false");
  return static_cast<bool>(*value);
}

std::optional<std::vector<std::string>> PrivateWords(const std::string& key) {
  auto value = PrivateValue(key);
  if (!value) return std::nullopt;
  if (value->getType() == XmlRpcValue::TypeString) {
    return hires::base::SplitWords(static_cast<std::string>(*value));
  }
  if (value->getType() != XmlRpcValue::TypeArray) Fail(key, *value, "a list of text, or text");
  std::vector<std::string> words;
  for (int i = 0; i < value->size(); ++i) {
    XmlRpcValue& word = (*value)[i];
    if (word.getType() != XmlRpcValue::TypeString) Fail(key, *value, "a list of text");
    words.push_back(static_cast<std::string>(word));
  }
  return words;
}

std::vector<std::string> PrivateActionLibraries() {
  const std::string paths = PrivateText("action_libraries").value_or("");
  return paths.empty() ? std::vector<std::string>() : hires::base::Split(paths, ':');
}

void RejectUnknownPrivate(const std::vector<std::string>& known) {
  const std::string prefix = ros::this_node::getName() + "/";
  std::vector<std::string> names;
  ros::param::getParamNames(names);
  for (const std::string& name : names) {
    if (name.rfind(prefix, 0) != 0) continue;
    const std::string key = hires::base::Split(name.substr(prefix.size()), '/').front();
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw ConfigError(hires::base::UnknownName("private parameter", key, known) + " (" + name +
                      "); remove it with `rosparam delete " + name + "`");
  }
}

std::string ConfigPath(const std::string& node) {
  const auto path = PrivateText("config");
  if (path && !path->empty()) return *path;
  throw ConfigError(fmt::format(
      "~config is missing: the path of the node's YAML file; use launch/{0}.launch, or add "
      "_config:=$(rospack find hires)/config/{0}.yaml",
      node));
}

}  // namespace hires_ros
