#include "hires/sensing/frame_tree.h"

namespace hires::sensing {

std::string BareFrame(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

}  // namespace hires::sensing
