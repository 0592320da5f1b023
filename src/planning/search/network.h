#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/program.h"

namespace hires::planning {

/// The tasks of a search: those still to be done, those that could come next, and, as a tree, how
/// each came to be. Everything can be taken back to a mark.
class Network {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kRoot = 2;  ///< first node; 0 and 1 are the anchors of lists

  explicit Network(TermTable* terms);

  struct Node {
    Term task;  ///< nil for the root and for networks in networks
    std::uint32_t parent{kNone};
    const CompiledNetwork* subtasks{nullptr};  ///< once decomposed
    std::uint32_t first_child{kNone};          ///< children stand one after the other
    std::uint32_t item{0};                     ///< which item of the parent's network
    std::uint32_t waiting{0};                  ///< items that have to be done before
    std::uint32_t left{0};                     ///< children not done yet
    bool immediate{false};
    std::uint64_t rest{0};     ///< hash of what follows when this is done
    std::uint64_t content{0};  ///< likewise, of tasks and order alone
    std::uint64_t join{0};     ///< of a network in which something waits for several: hash of it
    struct {
      std::uint32_t previous, next;
    } ready[2]{{kNone, kNone}, {kNone, kNone}};  ///< among all ready tasks; the immediate ones
  };

  std::size_t Remember() const { return trail_.size(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  /// @param mark, size  What Remember() and size() said.
  void Undo(std::size_t mark, std::uint32_t size);

  /// Lays out the network under `node`, a ready task or the root, which is no longer ready itself.
  /// @param tasks      The instantiated tasks, in the order of the items, nested ones in place.
  /// @param immediate  Which of the tasks that can come first is to go on at once (its number among
  ///                   them), or -1: as the file says.
  void Decompose(std::uint32_t node, const CompiledNetwork* network, const std::vector<Term>& tasks,
                 int immediate);
  void Finish(std::uint32_t node);  ///< a primitive task has been carried out

  std::uint32_t FirstReady() const { return nodes_[0].ready[0].next; }  ///< or 0: none
  std::uint32_t NextReady(std::uint32_t node) const { return nodes_[node].ready[0].next; }
  std::uint32_t FirstImmediate() const { return nodes_[1].ready[1].next; }  ///< or 1: none
  const Node& node(std::uint32_t index) const { return nodes_[index]; }
  bool done() const { return FirstReady() == 0; }

  /// The first child of the nearest node from `node` upwards that is not done: it and all nodes
  /// after it stand below that one, where no task outside of it was taken up in between.
  std::uint32_t FirstBelowOpen(std::uint32_t node) const;

  /// Of the tasks left with their order; meaningful while all of them are ground. Tells situations
  /// of one path apart.
  std::uint64_t hash() const { return hash_; }
  /// Likewise, and equal wherever the same tasks are left in the same order, on whatever path; of
  /// no use where two networks with the same tasks and order are under way, as it does not tell
  /// whose tasks are left, or where several tasks are to go on at once.
  std::uint64_t content() const { return content_; }
  std::uint64_t ContentFrom(std::uint32_t node) const;  ///< of ready tasks from that node on
  bool has_content() const {
    const std::uint32_t immediate = FirstImmediate();  // of several the first goes on, and no other
    return num_open_ == 0 && num_twins_ == 0 &&
           (immediate == 1 || nodes_[immediate].ready[1].next == 1);
  }
  bool all_ground() const { return num_open_ == 0; }
  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + trail_.capacity() * sizeof(Change);
  }

 private:
  enum class What : std::uint8_t { kReady, kNotReady, kWaiting, kLeft, kDecomposed, kOpen };
  struct Change {
    What what;
    std::uint32_t node;
  };
  struct Layout {  ///< what Decompose hands down
    const Term* next_task;
    int immediate;
  };

  void LayOut(std::uint32_t node, const CompiledNetwork* network, Layout* layout, bool first);
  void SetRests(std::uint32_t node);
  std::uint64_t HashOf(std::uint32_t node, std::uint64_t rest) const;
  std::uint64_t ContentOf(std::uint32_t node, std::uint64_t rest) const;
  void BeginJoin(std::uint64_t join);
  void EndJoin(std::uint64_t join);
  void EndJoins(std::uint32_t from);
  void Activate(std::uint32_t node);
  void Complete(std::uint32_t node);
  void MakeReady(std::uint32_t node);
  void MakeNotReady(std::uint32_t node);
  void Append(int list, std::uint32_t node);
  void Detach(int list, std::uint32_t node);
  void Reattach(int list, std::uint32_t node);
  std::uint64_t TaskHash(const Node& task, std::uint64_t rest) const;
  void Count(std::uint32_t node);
  void Discount(std::uint32_t node);

  TermTable* terms_;
  std::vector<Node> nodes_;
  std::vector<Change> trail_;
  std::uint64_t hash_{0};
  std::uint64_t content_{0};
  std::uint32_t num_open_{0};
  std::unordered_map<std::uint64_t, int> joins_;  ///< under way, by hash: how many
  int num_twins_{0};                              ///< beyond one of a hash
};

}  // namespace hires::planning
