#include "hires/ros/values/atom_messages.h"

namespace hires_ros {

hires::Atom ToMsg(const hires::base::Atom& atom) {
  hires::Atom message;
  message.predicate = atom.predicate;
  message.arguments = atom.arguments;
  return message;
}

std::vector<hires::Atom> ToMsg(const std::vector<hires::base::Atom>& atoms) {
  std::vector<hires::Atom> messages;
  for (const hires::base::Atom& atom : atoms) messages.push_back(ToMsg(atom));
  return messages;
}

std::vector<hires::base::Atom> FromMsg(const std::vector<hires::Atom>& atoms) {
  std::vector<hires::base::Atom> out;
  for (const hires::Atom& atom : atoms) out.push_back({atom.predicate, atom.arguments});
  return out;
}

}  // namespace hires_ros
