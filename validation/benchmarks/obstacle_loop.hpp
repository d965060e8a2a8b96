// The way of most published billiard programs (e.g. Datseris 2017): in doubles, a time to each
// obstacle by the formula of its kind, the least of them taken, arcs by the mathematical library.
// No decision is certain, and what stands on an obstacle is told by a small length. Short and plain
// on purpose: the event engine is compared with its speed only.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace carom::bench {

struct Flyer {
  double x, y, vx, vy;
};

constexpr double none = std::numeric_limits<double>::infinity();
constexpr double standing = 1e-10;  ///< flights shorter than that begin and end on one obstacle

class Obstacle {
 public:
  virtual ~Obstacle() = default;
  virtual double straight(const Flyer&) const = 0;
  /// About the centre (cx, cy), anticlockwise for omega > 0; speed 1.
  virtual double bent(const Flyer&, double cx, double cy, double omega) const = 0;
  virtual void normal(const Flyer&, double& nx, double& ny) const = 0;

 protected:
  /// From the flyer to a point of its circle.
  static double arc_time(const Flyer& p, double cx, double cy, double omega, double x, double y) {
    const double ax = p.x - cx, ay = p.y - cy, bx = x - cx, by = y - cy;
    double angle = std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    if (omega < 0) angle = -angle;
    if (angle < 0) angle += 2 * M_PI;
    const double time = angle / std::fabs(omega);
    return time < standing ? none : time;
  }
};

class SegmentObstacle : public Obstacle {
 public:
  SegmentObstacle(double x0, double y0, double x1, double y1) : x0_(x0), y0_(y0) {
    length_ = std::hypot(x1 - x0, y1 - y0);
    tx_ = (x1 - x0) / length_;
    ty_ = (y1 - y0) / length_;
  }
  double straight(const Flyer& p) const override {
    const double towards = p.vx * ty_ - p.vy * tx_;
    if (towards <= 0) return none;
    const double time = ((x0_ - p.x) * ty_ - (y0_ - p.y) * tx_) / towards;
    const double along = (p.x + time * p.vx - x0_) * tx_ + (p.y + time * p.vy - y0_) * ty_;
    return time < standing || along < 0 || along > length_ ? none : time;
  }
  double bent(const Flyer& p, double cx, double cy, double omega) const override {
    const double foot = (cx - x0_) * tx_ + (cy - y0_) * ty_;
    const double off = (cx - x0_) * ty_ - (cy - y0_) * tx_;
    const double square = 1 / (omega * omega) - off * off;
    if (square <= 0) return none;
    const double half = std::sqrt(square);
    double best = none;
    for (const double along : {foot - half, foot + half})
      if (along >= 0 && along <= length_)
        best = std::fmin(best, arc_time(p, cx, cy, omega, x0_ + along * tx_, y0_ + along * ty_));
    return best;
  }
  void normal(const Flyer&, double& nx, double& ny) const override {
    nx = -ty_;
    ny = tx_;
  }

 private:
  double x0_, y0_, tx_, ty_, length_;
};

/// The half of a circle on the side (fx, fy) of its centre, seen from inside.
class HalfCircleObstacle : public Obstacle {
 public:
  HalfCircleObstacle(double x, double y, double radius, double fx, double fy)
      : x_(x), y_(y), radius_(radius), fx_(fx), fy_(fy) {}
  double straight(const Flyer& p) const override {
    const double ex = p.x - x_, ey = p.y - y_;
    const double b = ex * p.vx + ey * p.vy, c = ex * ex + ey * ey - radius_ * radius_;
    const double square = b * b - c;
    if (square <= 0) return none;
    const double root = std::sqrt(square);
    double best = none;
    for (const double time : {-b - root, -b + root})
      if (time > standing && on(p.x + time * p.vx, p.y + time * p.vy)) best = std::fmin(best, time);
    return best;
  }
  double bent(const Flyer& p, double cx, double cy, double omega) const override {
    const double r = 1 / std::fabs(omega), dx = cx - x_, dy = cy - y_,
                 d = std::sqrt(dx * dx + dy * dy);
    if (d > r + radius_ || d < std::fabs(r - radius_)) return none;
    const double along = (radius_ * radius_ - r * r + d * d) / (2 * d);
    const double off = std::sqrt(std::fmax(0.0, radius_ * radius_ - along * along));
    double best = none;
    for (const double side : {off, -off}) {
      const double x = x_ + (along * dx - side * dy) / d, y = y_ + (along * dy + side * dx) / d;
      if (on(x, y)) best = std::fmin(best, arc_time(p, cx, cy, omega, x, y));
    }
    return best;
  }
  void normal(const Flyer& p, double& nx, double& ny) const override {
    // By the distance, not the radius: errors of place would grow into the speed.
    const double distance = std::hypot(x_ - p.x, y_ - p.y);
    nx = (x_ - p.x) / distance;
    ny = (y_ - p.y) / distance;
  }

 private:
  bool on(double x, double y) const { return (x - x_) * fx_ + (y - y_) * fy_ >= 0; }
  double x_, y_, radius_, fx_, fy_;
};

using Obstacles = std::vector<std::unique_ptr<Obstacle>>;

inline Obstacles unit_square() {
  Obstacles o;
  o.push_back(std::make_unique<SegmentObstacle>(0, 0, 1, 0));
  o.push_back(std::make_unique<SegmentObstacle>(1, 0, 1, 1));
  o.push_back(std::make_unique<SegmentObstacle>(1, 1, 0, 1));
  o.push_back(std::make_unique<SegmentObstacle>(0, 1, 0, 0));
  return o;
}
inline Obstacles unit_stadium() {
  Obstacles o;
  o.push_back(std::make_unique<SegmentObstacle>(-1, -1, 1, -1));
  o.push_back(std::make_unique<HalfCircleObstacle>(1, 0, 1, 1, 0));
  o.push_back(std::make_unique<SegmentObstacle>(1, 1, -1, 1));
  o.push_back(std::make_unique<HalfCircleObstacle>(-1, 0, 1, -1, 0));
  return o;
}

struct LoopResult {
  std::uint64_t hits = 0;
  double time = 0.0;
  bool left = false;  ///< no obstacle was found
};

inline LoopResult fly_among(const Obstacles& obstacles, double omega, std::uint64_t hits) {
  Flyer p{0.3, 0.4, std::cos(1.0), std::sin(1.0)};
  LoopResult result;
  for (; result.hits < hits; ++result.hits) {
    const double cx = omega != 0 ? p.x - p.vy / omega : 0, cy = omega != 0 ? p.y + p.vx / omega : 0;
    double least = none;
    const Obstacle* met = nullptr;
    for (const auto& obstacle : obstacles) {
      const double time = omega != 0 ? obstacle->bent(p, cx, cy, omega) : obstacle->straight(p);
      if (time < least) least = time, met = obstacle.get();
    }
    if (!met) {
      result.left = true;
      return result;
    }
    if (omega != 0) {
      const double c = std::cos(omega * least), s = std::sin(omega * least);
      const double ax = p.x - cx, ay = p.y - cy, vx = p.vx, vy = p.vy;
      p = {cx + c * ax - s * ay, cy + s * ax + c * ay, c * vx - s * vy, s * vx + c * vy};
    } else {
      p.x += least * p.vx;
      p.y += least * p.vy;
    }
    double nx, ny;
    met->normal(p, nx, ny);
    const double twice = 2 * (p.vx * nx + p.vy * ny);
    p.vx -= twice * nx;
    p.vy -= twice * ny;
    result.time += least;
  }
  return result;
}

}  // namespace carom::bench
