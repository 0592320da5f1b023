#include "planning/search/network.h"

#include "planning/proof/mix.h"

namespace hires::planning {
namespace {

constexpr std::uint32_t kAll = 0;        // list of all ready tasks, anchored at node 0
constexpr std::uint32_t kImmediate = 1;  // list of those that are immediate, anchored at node 1

}  // namespace

Network::Network(TermTable* terms) : terms_(terms), nodes_(3) {
  nodes_[kAll].ready[kAll] = {kAll, kAll};
  nodes_[kImmediate].ready[kImmediate] = {kImmediate, kImmediate};
}

// Lists of ready tasks. The links of a node that left stay, so that it can come back in its place.

void Network::Append(int list, std::uint32_t node) {
  const std::uint32_t anchor = static_cast<std::uint32_t>(list);
  const std::uint32_t last = nodes_[anchor].ready[list].previous;
  nodes_[node].ready[list] = {last, anchor};
  Reattach(list, node);
}

void Network::Reattach(int list, std::uint32_t node) {
  const auto links = nodes_[node].ready[list];
  nodes_[links.previous].ready[list].next = node;
  nodes_[links.next].ready[list].previous = node;
}

void Network::Detach(int list, std::uint32_t node) {
  const auto links = nodes_[node].ready[list];
  nodes_[links.previous].ready[list].next = links.next;
  nodes_[links.next].ready[list].previous = links.previous;
}

/// Of a task and what follows it.
std::uint64_t Network::TaskHash(const Node& task, std::uint64_t rest) const {
  return Mix(Mix(terms_->Hash(task.task), task.immediate), rest);
}

void Network::Count(std::uint32_t node) {
  hash_ += TaskHash(nodes_[node], nodes_[node].rest);
  content_ += TaskHash(nodes_[node], nodes_[node].content);
}

void Network::Discount(std::uint32_t node) {
  hash_ -= TaskHash(nodes_[node], nodes_[node].rest);
  content_ -= TaskHash(nodes_[node], nodes_[node].content);
}

void Network::MakeReady(std::uint32_t node) {
  Append(kAll, node);
  if (nodes_[node].immediate) Append(kImmediate, node);
  Count(node);
  trail_.push_back({What::kReady, node});
}

void Network::MakeNotReady(std::uint32_t node) {
  Detach(kAll, node);
  if (nodes_[node].immediate) Detach(kImmediate, node);
  Discount(node);
  trail_.push_back({What::kNotReady, node});
}

void Network::Undo(std::size_t mark, std::uint32_t size) {
  while (trail_.size() > mark) {
    const Change change = trail_.back();
    trail_.pop_back();
    Node& node = nodes_[change.node];
    switch (change.what) {
      case What::kReady:
        Detach(kAll, change.node);
        if (node.immediate) Detach(kImmediate, change.node);
        Discount(change.node);
        break;
      case What::kNotReady:
        Reattach(kAll, change.node);
        if (node.immediate) Reattach(kImmediate, change.node);
        Count(change.node);
        break;
      case What::kWaiting:
        ++node.waiting;
        break;
      case What::kLeft:
        if (node.left++ == 0 && node.join != 0) BeginJoin(node.join);
        break;
      case What::kDecomposed:
        EndJoins(node.first_child);
        if (node.join != 0) EndJoin(node.join);
        node.join = 0;
        node.subtasks = nullptr;
        node.first_child = kNone;
        node.left = 0;
        break;
      case What::kOpen:
        --num_open_;
        break;
    }
  }
  nodes_.resize(size);
}

void Network::Decompose(std::uint32_t node, const CompiledNetwork* network,
                        const std::vector<Term>& tasks, int immediate) {
  if (node != kRoot) MakeNotReady(node);
  if (network->items.empty()) return Complete(node);
  trail_.push_back({What::kDecomposed, node});
  Layout layout{tasks.data(), immediate};
  LayOut(node, network, &layout, true);
  SetRests(node);
  Activate(node);
}

void Network::LayOut(std::uint32_t node, const CompiledNetwork* network, Layout* layout,
                     bool first) {
  const std::uint32_t children = size();
  nodes_[node].subtasks = network;
  nodes_[node].first_child = children;
  nodes_[node].left = static_cast<std::uint32_t>(network->items.size());
  nodes_.resize(children + network->items.size());
  for (std::uint32_t i = 0; i < network->items.size(); ++i) {
    const CompiledNetwork::Item& item = network->items[i];
    Node& child = nodes_[children + i];
    child.parent = node;
    child.item = i;
    child.waiting = item.num_before;
    const bool child_first = first && item.num_before == 0;
    if (item.network != nullptr) {
      LayOut(children + i, item.network, layout, child_first);
      continue;
    }
    child.task = *layout->next_task++;
    child.immediate = item.immediate || (child_first && layout->immediate-- == 0);
    if (!terms_->IsGround(child.task)) {
      ++num_open_;
      trail_.push_back({What::kOpen, children + i});
    }
  }
}

// What follows an item: along a chain the next items, fold by fold; elsewhere "the join of these
// siblings, then what follows the parent". A join is told from others by its node, which no other
// node on a path shares; in the content, which is to be equal on all paths, by its tasks and their
// order. Where nothing follows the parent, nothing waits for the join either.
void Network::SetRests(std::uint32_t node) {
  const CompiledNetwork& network = *nodes_[node].subtasks;
  const std::uint32_t first = nodes_[node].first_child;
  std::uint64_t rest = nodes_[node].rest;
  std::uint64_t content = nodes_[node].content;
  bool ordered = network.items.size() > 1 && !network.chain;
  for (const CompiledNetwork::Item& item : network.items) {
    if (ordered && item.num_before > 0 && rest == 0) rest = content = 1;
  }
  if (!network.chain && rest != 0) {
    nodes_[node].join = content = ContentOf(node, content) | 1;
    BeginJoin(content);
  }
  for (std::size_t i = network.items.size(); i-- > 0;) {
    const std::uint32_t child = first + static_cast<std::uint32_t>(i);
    if (!network.chain) {
      nodes_[child].rest = rest == 0 ? 0 : Mix(Mix(node, i), rest);
      nodes_[child].content = rest == 0 ? 0 : Mix(content, i);
    } else {
      nodes_[child].rest = rest;
      nodes_[child].content = content;
    }
    if (network.items[i].network != nullptr) SetRests(child);
    if (!network.chain) continue;
    rest = HashOf(child, rest);
    content = ContentOf(child, content);
  }
}

void Network::BeginJoin(std::uint64_t join) {
  if (joins_[join]++ > 0) ++num_twins_;
}

void Network::EndJoin(std::uint64_t join) {
  const auto entry = joins_.find(join);
  if (--entry->second > 0) {
    --num_twins_;
  } else {
    joins_.erase(entry);
  }
}

/// Of the networks in a network that is taken back.
void Network::EndJoins(std::uint32_t from) {
  for (std::uint32_t node = from; node < size(); ++node) {
    if (nodes_[node].join != 0 && nodes_[node].left > 0) EndJoin(nodes_[node].join);
    nodes_[node].join = 0;  // they may still stand when what is above them is taken back
  }
}

std::uint32_t Network::FirstBelowOpen(std::uint32_t node) const {
  while (node != kNone && nodes_[node].left == 0) node = nodes_[node].parent;
  return node == kNone ? 0 : nodes_[node].first_child;
}

std::uint64_t Network::ContentFrom(std::uint32_t node) const {
  std::uint64_t content = 0;
  for (std::uint32_t ready = FirstReady(); ready != 0; ready = NextReady(ready)) {
    if (ready >= node) content += TaskHash(nodes_[ready], nodes_[ready].content);
  }
  return content;
}

/// Of a task, or of a network with all of its tasks and their order, and of what follows.
std::uint64_t Network::ContentOf(std::uint32_t node, std::uint64_t rest) const {
  const Node& item = nodes_[node];
  if (item.first_child == kNone) return TaskHash(item, rest);
  std::uint64_t hash = Mix(item.subtasks->items.size(), rest);
  for (std::uint32_t i = 0; i < item.subtasks->items.size(); ++i) {
    hash = Mix(hash, ContentOf(item.first_child + i, item.subtasks->items[i].num_before));
    for (const std::uint32_t after : item.subtasks->items[i].after) hash = Mix(hash, after);
  }
  return hash;
}

std::uint64_t Network::HashOf(std::uint32_t node, std::uint64_t rest) const {
  const Node& item = nodes_[node];
  if (item.first_child == kNone) return TaskHash(item, rest);
  std::uint64_t hash = Mix(node, rest);
  for (std::uint32_t i = 0; i < item.subtasks->items.size(); ++i) {
    hash = Mix(hash, HashOf(item.first_child + i, i));
  }
  return hash;
}

void Network::Activate(std::uint32_t node) {
  if (nodes_[node].first_child == kNone) return MakeReady(node);
  const CompiledNetwork& network = *nodes_[node].subtasks;
  const std::uint32_t first = nodes_[node].first_child;
  for (std::uint32_t i = 0; i < network.items.size(); ++i) {
    if (network.items[i].num_before == 0) Activate(first + i);
  }
}

void Network::Finish(std::uint32_t node) {
  MakeNotReady(node);
  Complete(node);
}

// First what waited for this one, then, where this was the last of its siblings, their parent.
void Network::Complete(std::uint32_t node) {
  while (nodes_[node].parent != kNone) {
    const std::uint32_t parent = nodes_[node].parent;
    const std::uint32_t first = nodes_[parent].first_child;
    for (const std::uint32_t after : nodes_[parent].subtasks->items[nodes_[node].item].after) {
      trail_.push_back({What::kWaiting, first + after});
      if (--nodes_[first + after].waiting == 0) Activate(first + after);
    }
    trail_.push_back({What::kLeft, parent});
    if (--nodes_[parent].left > 0) return;
    if (nodes_[parent].join != 0) EndJoin(nodes_[parent].join);
    node = parent;
  }
}

}  // namespace hires::planning
