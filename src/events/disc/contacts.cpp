#include "events/disc/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"
#include "carom/geometry/prepared_curve.hpp"
#include "motion/contact.hpp"
#include "motion/free_motion.hpp"

namespace carom::events {

using geometry::Cell;
using geometry::Vector;

namespace {

using base::at;
constexpr double infinity = std::numeric_limits<double>::infinity();
double norm_1(Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

}  // namespace

/// Two discs from the later of their starts on.
struct PairStart {
  Time time;
  motion::PairFlight flight;
};

namespace {

/// The place of a disc after a duration; the same numbers as those of moved.
struct Moved {
  Vector position, velocity;
};
inline Moved after(const Contacts::Disc& d, double duration) {
  if (d.omega == 0.0) return {geometry::moved(d.position, duration, d.velocity), d.velocity};
  const auto [x, v] = motion::moved(d.position, d.velocity, d.omega, duration);
  return {x, v};
}

inline PairStart start_of(const Contacts::Disc& a, const Contacts::Disc& b) {
  PairStart s;
  s.time = std::max(a.time, b.time);
  const Moved first = after(a, s.time - a.time), second = after(b, s.time - b.time);
  s.flight = {first.position - second.position, first.velocity, second.velocity, a.omega, b.omega};
  return s;
}

}  // namespace

/// How far a disc gets from where it is.
double Contacts::reach_within(const Disc& disc, double duration) const {
  const double way = disc.speed > 0.0 ? disc.speed * duration : 0.0;
  return disc.omega == 0.0 ? way : std::min(way, 2.0 * disc.speed / std::fabs(disc.omega));
}

void Contacts::try_copy(int i, int j, const PairStart& start, const Cell& copy, const Time& end) {
  Disc& a = disc(i);
  const Disc& b = disc(j);
  motion::PairFlight flight = start.flight;
  flight.separation = separation(flight.separation, {}, copy);
  const double t = motion::time_to_contact(flight, a.radius + b.radius, end - start.time);
  if (!(t < motion::no_contact)) return;
  const Time when = start.time + t;
  if (!(when < end)) return;
  if (partner(i) >= 0 && !(when < a.meeting)) return;
  partners_[at(i)] = j;
  a.meeting = when;
  a.copy = copy;
}

void Contacts::first_contact(int i, int j, const Time& now, const Time& until) {
  const Disc& a = disc(i);
  const Disc& b = disc(j);
  if (!(a.speed > 0.0 || b.speed > 0.0)) return;
  const Time end = std::min(until, std::min(b.own, b.check));
  const PairStart start = start_of(a, b);
  if (!(start.time < end)) return;
  const bool straight = a.omega == 0.0 && b.omega == 0.0;
  const Vector v = start.flight.first - start.flight.second;
  if (lattice_ == nullptr) {
    if (straight && !(dot(start.flight.separation, v) < 0.0)) return;  // moving apart
    return try_copy(i, j, start, {}, end);
  }
  // Their places at this time tell which copies are near.
  const Time from = std::max(now, start.time);
  Vector d = start.flight.separation;
  const double since = from - start.time;
  if (straight)
    d = d + since * v;
  else if (since > 0.0)
    d = d + (motion::moved({}, start.flight.first, a.omega, since).first -
             motion::moved({}, start.flight.second, b.omega, since).first);
  const Cell near = nearest(d);
  if (binned_) {
    if (straight && !(dot(separation(start.flight.separation, {}, near), v) < 0.0)) return;
    return try_copy(i, j, start, near, end);
  }
  const double left = end - from;
  double way = reach_within(a, left) + reach_within(b, left);
  if (a.omega == b.omega) {
    const double relative = length(v);
    way = std::min(way, a.omega == 0.0
                            ? relative * left
                            : std::min(relative * left, 2.0 * relative / std::fabs(a.omega)));
    if (!(relative > 0.0)) way = 0.0;
  }
  // The nearest copy is at most half a cell's diameter away: farther copies only as far as they are
  // reached.
  const Vector rest = separation(d, {}, near);
  const Vector p = lattice_->translation(along_), q = lattice_->translation(beyond_);
  const double p2 = dot(p, p), width = std::sqrt(p2), area = geometry::cross(p, q);
  const double nearest_reach = 1.01 * (a.radius + b.radius + way);
  // How many rows and places in a row at most, and from that what is rounded in the sums of
  // multiples of the vectors as they are written: three units of each multiple, and of d eight of
  // what it is made of.
  const auto spread = [this](const Cell& c) {
    return std::fabs(static_cast<double>(c.first)) * norm_1(lattice_->first) +
           std::fabs(static_cast<double>(c.second)) * norm_1(lattice_->second);
  };
  const double rows_most = (norm_1(rest) + nearest_reach) * width / std::fabs(area) + 2.0,
               most = (norm_1(rest) + nearest_reach + rows_most * norm_1(q)) / width + 2.0;
  const double slack =
      8.0 * geometry::unit_roundoff *
      (norm_1(start.flight.separation) + (a.speed + b.speed) * std::fabs(since) + spread(near) +
       rows_most * spread(beyond_) + most * spread(along_) + nearest_reach);
  const double reach = a.radius + b.radius + way + slack;
  // Row by row along the shortest lattice vector p, as far as a row comes near enough: e = rest - m
  // p - n q. What may lie in reach by rounding is asked too; the distance decides.
  const double row = geometry::cross(p, rest) / area, rows = reach * width / std::fabs(area);
  for (double n = std::floor(row - rows); n <= row + rows + 1.0; ++n) {
    const Vector r = rest - n * q;
    const double off = geometry::cross(p, r) / width, middle = dot(r, p) / p2;
    const double half = std::sqrt(std::max((reach - off) * (reach + off), 0.0)) / width;
    for (double m = std::floor(middle - half); m <= middle + half + 1.0; ++m) {
      const auto k = static_cast<std::int64_t>(m), l = static_cast<std::int64_t>(n);
      const Cell by{k * along_.first + l * beyond_.first, k * along_.second + l * beyond_.second};
      const Vector e = separation(rest, {}, by);
      if (!(dot(e, e) <= reach * reach)) continue;
      try_copy(i, j, start, {near.first + by.first, near.second + by.second}, end);
    }
  }
}

void Contacts::predict(int i, const Time& now) {
  Disc& a = disc(i);
  partners_[at(i)] = -1;
  if (!a.here) return;
  const Time until = std::min(a.own, a.check);
  if (!binned_) {
    for (int j = 0; j < size(); ++j)
      if (j != i && disc(j).here) first_contact(i, j, now, until);
    return;
  }
  const int column = a.bin % columns_, row = a.bin / columns_;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      int k = c, l = r;
      if (lattice_ != nullptr) {
        k = (c + columns_) % columns_;
        l = (r + rows_) % rows_;
      } else if (k < 0 || k >= columns_ || l < 0 || l >= rows_) {
        continue;
      }
      for (const int j : bins_[at(l * columns_ + k)])
        if (j != i) first_contact(i, j, now, until);
    }
  }
}

void Contacts::partners_of(int i, std::vector<int>& found) const {
  found.clear();
  for (int j = 0; j < size(); ++j)
    if (partners_[at(j)] == i) found.push_back(j);
}

Cell Contacts::nearest(Vector d) const {
  Cell copy;
  if (dot(d, d) < unique_ * unique_) return copy;  // nearer than any other copy can be
  for (bool moved_on = true; moved_on;) {
    moved_on = false;
    for (const geometry::CellEdge& e : lattice_->edges) {
      const Vector nearer = d - lattice_->translation(e.beyond);
      if (!(dot(nearer, nearer) < dot(d, d))) continue;
      d = nearer;
      copy.first += e.beyond.first;
      copy.second += e.beyond.second;
      moved_on = true;
    }
  }
  return copy;
}

int Contacts::bin_of(Vector x) const {
  double p = 0.0, q = 0.0;
  if (lattice_ != nullptr) {
    const double area = geometry::cross(lattice_->first, lattice_->second);
    p = geometry::cross(x, lattice_->second) / area;
    q = geometry::cross(lattice_->first, x) / area;
    p = (p - std::floor(p)) * columns_;
    q = (q - std::floor(q)) * rows_;
  } else {
    p = (x.x - low_.x) / width_;
    q = (x.y - low_.y) / height_;
  }
  const int column = static_cast<int>(std::clamp(p, 0.0, columns_ - 1.0));
  const int row = static_cast<int>(std::clamp(q, 0.0, rows_ - 1.0));
  return row * columns_ + column;
}

void Contacts::anchor(int i, const Time& now) {
  Disc& a = disc(i);
  if (!binned_) {
    const double ahead = a.speed > 0.0 ? std::max(horizon_, spacing_ / a.speed) : infinity;
    a.check = ahead < infinity ? std::max(now, a.time) + ahead : Time(infinity);
    return;
  }
  leave(i);
  const Time from = std::max(now, a.time);
  a.here = true;
  a.bin = bin_of(motion::moved(a.position, a.velocity, a.omega, from - a.time).first);
  bins_[at(a.bin)].push_back(i);
  a.check = a.speed > 0.0 ? from + slack_ / a.speed : Time(infinity);
}

void Contacts::leave(int i) {
  Disc& a = disc(i);
  a.here = false;
  partners_[at(i)] = -1;
  if (a.bin < 0) return;
  std::erase(bins_[at(a.bin)], i);
  a.bin = -1;
}

/// Bins wide enough for the neighbours, if three of them fit side by side and it pays.
void Contacts::choose_bins(const Time& now) {
  double radius = 0.0;
  int count = 0;
  Vector low{infinity, infinity}, high{-infinity, -infinity};
  for (const Disc& d : discs_) {
    if (!d.here) continue;
    ++count;
    radius = std::max(radius, d.radius);
    const Vector x =
        motion::moved(d.position, d.velocity, d.omega, std::max(now, d.time) - d.time).first;
    low = {std::min(low.x, x.x), std::min(low.y, x.y)};
    high = {std::max(high.x, x.x), std::max(high.y, x.y)};
  }
  binned_ = false;
  spacing_ = count > 0 ? std::max(high.x - low.x, high.y - low.y) / std::sqrt(count) : 0.0;
  if (count < 16) return;
  double across = high.x - low.x, up = high.y - low.y;
  if (lattice_ != nullptr) {
    across = lattice_->cell_area() / length(lattice_->second);
    up = lattice_->cell_area() / length(lattice_->first);
  }
  // The wider the bins, the more neighbours in them; the narrower, the sooner a disc must be
  // anchored anew.
  const double spacing = std::sqrt(across * up / count);
  slack_ = std::max(0.5 * radius, 0.5 * spacing);
  const double wide =
      (2.0 * radius + 2.0 * slack_) * (1.0 + 0x1p-20);  // more than any rounding of positions
  columns_ = static_cast<int>(std::min(std::floor(across / wide), 1024.0));
  rows_ = static_cast<int>(std::min(std::floor(up / wide), 1024.0));
  binned_ = columns_ >= 3 && rows_ >= 3;
  // A copy that is touched must be the nearest one: it is at most the reach and four slacks away.
  if (lattice_ != nullptr && !(2.0 * radius + 4.0 * slack_ < unique_)) binned_ = false;
  if (!binned_) return;
  low_ = low;
  width_ = across / columns_;
  height_ = up / rows_;
}

bool Contacts::tell_partner(int i) {
  const int j = partner(i);
  const Disc& a = disc(i);
  Disc& b = disc(j);
  if (partner(j) >= 0 && !(a.meeting < b.meeting)) return false;
  partners_[at(j)] = i;
  b.meeting = a.meeting;
  b.copy = {-a.copy.first, -a.copy.second};
  return true;
}

Contacts::Contacts(const geometry::Lattice* lattice)
    : lattice_(lattice), unique_(largest_radius()) {
  if (lattice == nullptr) return;
  // Two neighbours of a cell side by side are a basis.
  const std::vector<geometry::CellEdge>& edges = lattice->edges;
  double shortest = infinity;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double l = length(lattice->translation(edges[k].beyond));
    if (!(l < shortest)) continue;
    shortest = l;
    along_ = edges[k].beyond;
    beyond_ = edges[(k + 1) % edges.size()].beyond;
  }
}

void Contacts::prepare(const Time& now) {
  double omega = 0.0;
  bool equal = true;
  for (const Disc& d : discs_) {
    if (!d.here) continue;
    omega = std::max(omega, std::fabs(d.omega));
    equal = equal && d.omega == discs_.front().omega;
  }
  horizon_ = equal ? infinity : 6.0 / omega;
  choose_bins(now);
  bins_.assign(binned_ ? at(columns_ * rows_) : 0, {});
  for (int i = 0; i < size(); ++i) {
    disc(i).bin = -1;
    if (disc(i).here) anchor(i, now);
  }
}

double Contacts::largest_radius() const {
  if (lattice_ == nullptr) return infinity;
  double shortest = infinity;
  for (const geometry::CellEdge& e : lattice_->edges)
    shortest = std::min(shortest, length(lattice_->translation(e.beyond)));
  return 0.5 * shortest;
}

int Contacts::overlapped(const Disc& a) const {
  for (int j = 0; j < size(); ++j) {
    const Disc& b = disc(j);
    if (!b.here) continue;
    const PairStart start = start_of(a, b);
    Vector d = start.flight.separation;
    double size = norm_1(a.position) + norm_1(b.position) + a.radius + b.radius;
    size += a.speed * (start.time - a.time) + b.speed * (start.time - b.time);
    if (lattice_ != nullptr) {
      const Cell copy = nearest(d);
      size += norm_1(lattice_->translation(copy));
      d = separation(d, {}, copy);
    }
    // Decimal numbers that were meant to touch, or states at a contact, overlap by some roundings.
    if (length(d) < a.radius + b.radius - 64.0 * geometry::unit_roundoff * size) return j;
  }
  return -1;
}

}  // namespace carom::events
