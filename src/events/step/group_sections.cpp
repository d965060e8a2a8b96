// Crossings of a surface within a step of an integrator, by the scheme's own partial steps.
#include <cmath>

#include "events/bracketed_root.hpp"
#include "events/step/group.hpp"

namespace carom::events {

using geometry::Vector;

namespace {

// Parts a step is looked at in, where it comes near the surface: within each, the surface is met at
// most twice, as happens where the path turns round.
constexpr int parts = 4;

class SectionSearch {
 public:
  using Knot = StepPath<double>::Knot;

  SectionSearch(StepPath<double>& path, const Surface& surface, std::size_t member, Vector origin,
                std::vector<SurfaceCrossing>& found)
      : path_(path), surface_(surface), member_(member), origin_(origin), found_(found) {}

  void search(double from, double to) {
    Knot &a = path_.at(from), &b = path_.at(to);
    const double ga = g(a), gb = g(b);
    // Far from the surface: even twice the larger rate does not reach it.
    const double reach = 2.0 * (to - from) * std::fmax(std::fabs(rate(a)), std::fabs(rate(b)));
    if ((ga > 0.0) == (gb > 0.0) && std::fmin(std::fabs(ga), std::fabs(gb)) > reach && !turns(a, b))
      return;
    Knot* before = &a;
    for (int i = 1; i <= parts; ++i) {
      const double time = i == parts ? to : from + (to - from) * i / parts;
      Knot& after = path_.at(time);
      part(*before, after);
      before = &after;
    }
  }

  // For bracketed_root.
  Knot* at(double time) { return &path_.at(time); }
  static double time(const Knot* k) { return k->time; }
  double g(const Knot* k) const { return g(*k); }
  double rate(Knot* k) const { return rate(*k); }

 private:
  Vector position(const Knot& k) const { return k.phase.position[member_] + origin_; }
  double g(const Knot& k) const {
    return surface_function(surface_, position(k), k.phase.velocity[member_]);
  }
  double rate(Knot& k) const {
    const Vector a = of_velocity(surface_) ? path_.acceleration(k, member_) : Vector{};
    return surface_rate(surface_, position(k), k.phase.velocity[member_], a);
  }
  // Towards the surface at the start, away from it at the end?
  bool turns(Knot& a, Knot& b) const {
    const double side = g(a) > 0.0 ? 1.0 : -1.0;
    return side * rate(a) < 0.0 && side * rate(b) > 0.0;
  }

  void part(Knot& a, Knot& b) {
    if ((g(a) > 0.0) != (g(b) > 0.0)) return root(a, b);
    if (!turns(a, b)) return;
    // The turning point, until it lies beyond the surface or the rate is at its rounding.
    const bool side = g(a) > 0.0;
    Knot *low = &a, *high = &b;
    for (int i = 0; i < 60; ++i) {
      const double rl = rate(*low), rh = rate(*high);
      double time = low->time + (high->time - low->time) * (rl / (rl - rh));
      if (i % 3 == 2 || !(time > low->time && time < high->time))
        time = low->time + 0.5 * (high->time - low->time);
      if (!(time > low->time && time < high->time)) return;
      Knot& middle = path_.at(time);
      if ((g(middle) > 0.0) != side) {
        root(a, middle);
        return root(middle, b);
      }
      const double r = rate(middle);
      if (r == 0.0) return;
      ((r < 0.0) == (rl < 0.0) ? low : high) = &middle;
    }
  }

  // The only crossing between two knots on different sides.
  void root(Knot& a, Knot& b) {
    const Knot* found = bracketed_root(*this, &a, &b);
    if (on_surface_part(surface_, position(*found)))
      found_.push_back(
          {found->time, g(b) > 0.0 ? 1 : -1, position(*found), found->phase.velocity[member_]});
  }

  StepPath<double>& path_;
  const Surface& surface_;
  std::size_t member_;
  Vector origin_;
  std::vector<SurfaceCrossing>& found_;
};

}  // namespace

void Group::crossings(const Surface& surface, std::size_t member, double from, double to,
                      Vector origin, std::vector<SurfaceCrossing>& found) {
  found.clear();
  if (from < to) SectionSearch(*path_, surface, member, origin, found).search(from, to);
}

}  // namespace carom::events
