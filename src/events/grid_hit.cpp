// Flights among many walls: only those are looked at whose cells the flight passes.
#include <algorithm>
#include <cmath>

#include "events/crossing.hpp"
#include "events/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// With edges nothing matters outside the lattice's cell; else a flight may start anywhere, but what does not
/// reach a wall ends nowhere.
void HitFinder::make_grid(bool edges) {
  if (pieces_.empty()) return;
  std::vector<Box> boxes;
  const Vector none{0.0, 0.0};
  const Vector first = cells_ ? table_.lattice->first : none, second = cells_ ? table_.lattice->second : none;
  if (cells_ && edges) {
    for (const CellEdge& e : table_.lattice->edges) boxes.push_back(bounding_box(e.segment));
  } else {
    for (const Piece& p : pieces_) {
      Box box = bounding_box(p.curve);
      if (!(p.offset == Cell{})) {
        // Displaced, with the rounding on the safe side.
        const Vector t = table_.lattice->translation(p.offset);
        const double m = std::fabs(static_cast<double>(p.offset.first)), n = std::fabs(static_cast<double>(p.offset.second));
        const double size = std::max({std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.high.x), std::fabs(box.high.y)});
        const double margin = 8.0 * unit_roundoff * (m * norm_1(first) + n * norm_1(second) + size);
        box = {{box.low.x + t.x - margin, box.low.y + t.y - margin}, {box.high.x + t.x + margin, box.high.y + t.y + margin}};
      }
      boxes.push_back(box);
    }
  }
  Box within = boxes.front();
  for (const Box& b : boxes) {
    within.low = {std::min(within.low.x, b.low.x), std::min(within.low.y, b.low.y)};
    within.high = {std::max(within.high.x, b.high.x), std::max(within.high.y, b.high.y)};
  }
  grid_ = std::make_unique<const WallGrid>(pieces_, first, second, within);
  seen_.assign(data_.size(), 0);
}

/// On which side of the flight are the joints of some pieces?
template <bool larmor, bool cells>
bool HitFinder::see_joints(const Flight& f, std::span<const int> list) const {
  for (const int piece : list) {
    const PieceData& p = data_[at(piece)];
    if (p.closed) continue;
    const Origin& origin = origins_[cells ? at(p.offset) : 0];
    for (const int joint : {piece, p.next}) {
      const Vector d = joints_[at(joint)] - origin.point;
      const double side =
          larmor ? side_of_flight(f.velocity, d, f.omega) : 2.0 * geometry::cross(f.velocity, d);
      left_[at(joint)] = side > 0.0;
      if (!(std::fabs(side) > side_error(origin.scale, norm_1(d)))) return false;
    }
  }
  return true;
}

template bool HitFinder::see_joints<false, false>(const Flight&, std::span<const int>) const;
template bool HitFinder::see_joints<false, true>(const Flight&, std::span<const int>) const;
template bool HitFinder::see_joints<true, false>(const Flight&, std::span<const int>) const;
template bool HitFinder::see_joints<true, true>(const Flight&, std::span<const int>) const;

template <class Visit, class Passed>
void HitFinder::follow(const Flight& f, const Visit& visit, const Passed& passed) const {
  const Origin& own = origins_[0];
  const double delta = own.scale.delta * options_.filter_inflation;
  if (f.omega == 0.0)
    grid_->along_line(own.point, delta, f.velocity, visit, passed);
  else
    grid_->along_circle(own.point, delta, f.velocity, f.omega, std::sqrt(f.square_speed), visit, passed);
}

/// All pieces that the whole flight may meet, in their order: for the exact stage.
const std::vector<int>& HitFinder::pieces_on_way(const Flight& f) const {
  ++flights_;
  list_.clear();
  follow(
      f,
      [&](int cell) {
        for (const int piece : grid_->pieces(cell)) {
          if (seen_[at(piece)] == flights_) continue;
          seen_[at(piece)] = flights_;
          list_.push_back(piece);
        }
      },
      [](double) { return false; });
  std::sort(list_.begin(), list_.end());
  return list_;
}

template <bool larmor, bool cells>
bool HitFinder::filtered_in_grid(const Flight& f, Ahead& ahead) const {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  ++flights_;
  list_.clear();
  bool decided = true, fresh = false;
  double error = 0.0;
  ahead = Ahead();
  follow(
      f,
      [&](int cell) {
        for (const int piece : grid_->pieces(cell)) {
          if (seen_[at(piece)] == flights_) continue;
          seen_[at(piece)] = flights_;
          list_.push_back(piece);
          fresh = true;
        }
      },
      [&](double kappa) {
        if (fresh) {
          // The first of those so far, against those that are new.
          if (!filtered_of<larmor, cells, true>(f, ahead, list_, error)) {
            decided = false;
            return true;
          }
          list_.clear();
          if (ahead.kind != Ahead::Kind::none) list_.push_back(ahead.piece);
          fresh = false;
        }
        return ahead.kind != Ahead::Kind::none && ahead.kappa - error > kappa;
      });
  return decided;
}

void HitFinder::next_in_grid(const Flight& f, Ahead& ahead, DecisionCounts& counts) const {
  look_from(f);
  if (flights_ > 0xfffffff0u) {  // the counter of flights begins again
    std::fill(seen_.begin(), seen_.end(), 0);
    flights_ = 0;
  }
  if (f.omega == 0.0 ? (cells_ ? filtered_in_grid<false, true>(f, ahead) : filtered_in_grid<false, false>(f, ahead))
                     : (cells_ ? filtered_in_grid<true, true>(f, ahead) : filtered_in_grid<true, false>(f, ahead))) {
    ++counts.filter;
  } else {
    ++counts.exact;
    ahead = exact_next(f, pieces_on_way(f));
  }
  if (ahead.kind == Ahead::Kind::none) ahead.duration = 0.0;
}

}  // namespace carom
