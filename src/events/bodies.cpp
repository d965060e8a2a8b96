#include "events/bodies.hpp"

#include <utility>

#include "carom/events/report.hpp"
#include "events/step/group.hpp"

namespace carom::events {

int Bodies::add(Body body) {
  bodies_.push_back(std::move(body));
  queue_.push({});
  return size() - 1;
}

void Bodies::clear() {
  bodies_.clear();
  queue_.clear();
}

State Bodies::state_in_group(const Body& b) { return b.group->state(b.member); }

void Bodies::end(int i, Fate fate, Time time, Observer& observer, std::string_view why) {
  Body& b = (*this)[i];
  b.fate = fate;
  b.finished = true;
  b.ended = time;
  queue_.remove(i);
  if (fate == Fate::lost || fate == Fate::singular || fate == Fate::unresolved)
    b.report = report_of(b.particle, b.state, fate, why);
  observer.end({i, fate, time, b.state, b.hole, b.hits});
}

}  // namespace carom::events
