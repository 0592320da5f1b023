#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// Stores that read the file beside the one that writes it, one for each thread that asks at a
/// time. They are made when they are needed, and kept.
class BlackboardReaders {
 public:
  BlackboardReaders(std::string path, std::shared_ptr<const Ontology> ontology);

  /// Calls `read` with a store. @throws what it throws, ConfigError if the file cannot be opened.
  template <typename Call>
  auto Read(const Call& read) {
    Lease lease(this);
    return read(static_cast<const Store&>(*lease.store));
  }

 private:
  using StorePointer = std::unique_ptr<Store>;
  struct Lease {
    explicit Lease(BlackboardReaders* owner) : readers(owner), store(owner->Take()) {}
    ~Lease() { readers->GiveBack(std::move(store)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    BlackboardReaders* readers;
    StorePointer store;
  };

  StorePointer Take();
  void GiveBack(StorePointer store);

  const std::string path_;
  const std::shared_ptr<const Ontology> ontology_;
  std::mutex mutex_;
  std::vector<StorePointer> free_;  // guarded
};

}  // namespace hires::knowledge
