// The event queue: one entry a group, ordered by time, then kind, then index, so that runs repeat.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "carom/base/time.hpp"

namespace carom::events {

/// Indexed 4-ary heap. Entries are 0 … size-1; each has a key that may change at any time.
class EventQueue {
 public:
  struct Key {
    Time time;
    int kind = 0;
  };

  void clear() {
    heap_.clear();
    place_.clear();
    keys_.clear();
  }
  int size() const { return static_cast<int>(heap_.size()); }
  bool empty() const { return heap_.empty(); }

  /// Adds the entry with the next free index.
  void push(Key key) {
    const int entry = static_cast<int>(keys_.size());
    keys_.push_back(key);
    place_.push_back(heap_.size());
    heap_.push_back(entry);
    up(heap_.size() - 1);
  }
  int top() const { return heap_.front(); }
  const Key& key(int entry) const { return keys_[static_cast<std::size_t>(entry)]; }
  void update(int entry, const Time& time, int kind) {
    Key& key = keys_[static_cast<std::size_t>(entry)];
    key.time.high = time.high;  // number by number: a 16-byte copy would wait for both
    key.time.low = time.low;
    key.kind = kind;
    if (heap_.size() == 1) return;
    const std::size_t i = place_[static_cast<std::size_t>(entry)];
    up(i);
    down(place_[static_cast<std::size_t>(entry)]);
  }
  void update(int entry, const Key& key) { update(entry, key.time, key.kind); }
  /// Takes the entry out; its index is not used again.
  void remove(int entry) {
    const std::size_t i = place_[static_cast<std::size_t>(entry)];
    swap(i, heap_.size() - 1);
    heap_.pop_back();
    if (i < heap_.size()) {
      const int moved = heap_[i];
      up(i);
      down(place_[static_cast<std::size_t>(moved)]);
    }
  }

 private:
  bool before(int a, int b) const {
    const Key& x = key(a);
    const Key& y = key(b);
    if (x.time != y.time) return x.time < y.time;
    if (x.kind != y.kind) return x.kind < y.kind;
    return a < b;
  }
  void swap(std::size_t i, std::size_t j) {
    std::swap(heap_[i], heap_[j]);
    place_[static_cast<std::size_t>(heap_[i])] = i;
    place_[static_cast<std::size_t>(heap_[j])] = j;
  }
  void up(std::size_t i) {
    while (i > 0) {
      const std::size_t parent = (i - 1) / 4;
      if (!before(heap_[i], heap_[parent])) return;
      swap(i, parent);
      i = parent;
    }
  }
  void down(std::size_t i) {
    for (;;) {
      std::size_t first = i;
      for (std::size_t c = 4 * i + 1; c <= 4 * i + 4 && c < heap_.size(); ++c)
        if (before(heap_[c], heap_[first])) first = c;
      if (first == i) return;
      swap(i, first);
      i = first;
    }
  }

  std::vector<int> heap_;
  std::vector<std::size_t> place_;
  std::vector<Key> keys_;
};

}  // namespace carom::events
