// Hard discs of unit mass on a square torus by the plainest loop: after each contact both discs are
// asked for their next one with every other and its images, and the first of all pairs is found by
// looking at each. In doubles, nothing certain: the event engine is compared with its speed only.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace carom::bench {

class PairLoop {
 public:
  PairLoop(double side, double radius) : side_(side), diameter_(2.0 * radius) {}

  void add(double x, double y, double vx, double vy) { discs_.push_back({x, y, vx, vy}); }

  /// Follows `contacts` of them; the time that they take. `virial` adds up diameter times what each
  /// passes on.
  double run(long contacts, double& virial) {
    for (std::size_t i = 0; i < discs_.size(); ++i) predict(i);
    const double start = now_;
    for (; contacts > 0; --contacts) {
      std::size_t first = 0;
      for (std::size_t i = 1; i < discs_.size(); ++i)
        if (discs_[i].next < discs_[first].next) first = i;
      const std::size_t second = discs_[first].partner;
      move_to(discs_[first].next);
      virial += collide(discs_[first], discs_[second]);
      for (std::size_t i = 0; i < discs_.size(); ++i)
        if (i == first || i == second || discs_[i].partner == first || discs_[i].partner == second)
          predict(i);
    }
    return now_ - start;
  }

 private:
  struct Disc {
    double x, y, vx, vy, next = 0.0;
    std::size_t partner = 0;
  };

  double nearest(double d) const { return d - side_ * std::round(d / side_); }
  void move_to(double t) {
    for (Disc& d : discs_) d.x += (t - now_) * d.vx, d.y += (t - now_) * d.vy;
    now_ = t;
  }
  double collide(Disc& a, Disc& b) const {
    const double nx = nearest(b.x - a.x) / diameter_, ny = nearest(b.y - a.y) / diameter_;
    const double passed = (a.vx - b.vx) * nx + (a.vy - b.vy) * ny;
    a.vx -= passed * nx, a.vy -= passed * ny, b.vx += passed * nx, b.vy += passed * ny;
    return diameter_ * passed;
  }
  void predict(std::size_t i) {
    Disc& a = discs_[i];
    a.next = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < discs_.size(); ++j) {
      const Disc& b = discs_[j];
      if (j == i) continue;
      const double vx = b.vx - a.vx, vy = b.vy - a.vy, v2 = vx * vx + vy * vy,
                   x = nearest(b.x - a.x), y = nearest(b.y - a.y);
      for (int image = 0; image < 9; ++image) {
        const double dx = x + side_ * (image % 3 - 1), dy = y + side_ * (image / 3 - 1),
                     along = dx * vx + dy * vy;
        const double under = along * along - v2 * (dx * dx + dy * dy - diameter_ * diameter_);
        if (along >= 0.0 || under < 0.0) continue;
        const double t = now_ + (-along - std::sqrt(under)) / v2;
        if (t < a.next) a.next = t, a.partner = j;
      }
    }
  }

  double side_, diameter_, now_ = 0.0;
  std::vector<Disc> discs_;
};

}  // namespace carom::bench
