#include "events/samples.hpp"

#include "events/step/groups.hpp"

namespace carom::events {

void Samples::at(std::vector<double> times) {
  any_ = !times.empty();
  times_ = std::move(times);
  next_ = 0;
}

void Samples::every(double interval) {
  any_ = interval > 0.0;
  interval_ = interval;
  next_ = 0;
}

void Samples::emit(Time until, bool inclusive, Observer& observer) {
  for (;;) {
    double t = 0.0;
    if (!times_.empty()) {
      if (next_ >= times_.size()) return;
      t = times_[next_];
    } else if (interval_ > 0.0) {
      t = static_cast<double>(next_) * interval_;
    } else {
      return;
    }
    if (inclusive ? Time(t) > until : !(Time(t) < until)) return;
    bool any = false;
    seen_.clear();
    for (int i = 0; i < bodies_.size(); ++i) {
      const Body& b = bodies_[i];
      if (interrupt_.after(100.0)) return;
      if (b.finished && b.fate != Fate::pinned) continue;
      if (groups_.fails_before(i, t)) continue;
      any = true;
      if (bodies_.state(i).time > Time(t)) continue;  // it is still to come
      seen_.emplace_back(i, groups_.state_at(i, t));
    }
    for (const auto& [particle, state] : seen_) observer.sample(particle, t, state);
    if (!any) return;  // no particle is left to be sampled
    if (!observer.sampled(t)) return interrupt_.stop();
    ++next_;
  }
}

}  // namespace carom::events
