#include "hires/knowledge/blackboard_readers.h"

#include <utility>

namespace hires::knowledge {
namespace {

constexpr std::size_t kCacheBytes = 16u << 20;  // of each

}  // namespace

BlackboardReaders::BlackboardReaders(std::string path, std::shared_ptr<const Ontology> ontology)
    : path_(std::move(path)), ontology_(std::move(ontology)) {}

BlackboardReaders::StorePointer BlackboardReaders::Take() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!free_.empty()) {
      StorePointer store = std::move(free_.back());
      free_.pop_back();
      return store;
    }
  }
  StoreOptions options;
  options.read_only = true;
  options.cache_bytes = kCacheBytes;
  return std::make_unique<Store>(path_, ontology_, options);
}

void BlackboardReaders::GiveBack(StorePointer store) {
  const std::lock_guard<std::mutex> lock(mutex_);
  free_.push_back(std::move(store));
}

}  // namespace hires::knowledge
