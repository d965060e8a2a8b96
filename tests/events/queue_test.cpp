// The indexed heap against a sorted list.
#include "events/queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

namespace carom {

using namespace events;

namespace {

TEST(EventQueue, AgreesWithASortedList) {
  std::mt19937_64 random(1);
  EventQueue queue;
  struct Entry {
    double time;
    int kind;
    bool there;
  };
  std::vector<Entry> list;
  const auto first = [&] {
    int best = -1;
    for (int i = 0; i < static_cast<int>(list.size()); ++i) {
      const Entry& e = list[static_cast<std::size_t>(i)];
      if (!e.there) continue;
      if (best < 0) {
        best = i;
        continue;
      }
      const Entry& b = list[static_cast<std::size_t>(best)];
      if (std::tuple(e.time, e.kind) < std::tuple(b.time, b.kind)) best = i;
    }
    return best;
  };
  for (int step = 0; step < 20000; ++step) {
    const double time = static_cast<double>(random() % 50);  // many ties
    const int kind = static_cast<int>(random() % 3);
    const auto action = random() % 10;
    if (list.size() < 40 && (action == 0 || list.empty())) {
      queue.push({time, kind});
      list.push_back({time, kind, true});
    } else if (action == 1 && queue.size() > 1) {
      const int entry = queue.top();
      queue.remove(entry);
      list[static_cast<std::size_t>(entry)].there = false;
    } else {
      const std::size_t entry = random() % list.size();
      if (!list[entry].there) continue;
      queue.update(static_cast<int>(entry), {time, kind});
      list[entry] = {time, kind, true};
    }
    ASSERT_EQ(queue.top(), first());
  }
}

}  // namespace
}  // namespace carom
