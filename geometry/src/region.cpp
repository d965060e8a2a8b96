// The check of a region: closed, simple, oriented, nested.
#include "carom/geometry/region.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "carom/geometry/hull.hpp"
#include "carom/geometry/lattice_copies.hpp"
#include "contact.hpp"
#include "exact_loop.hpp"
#include "hull_contact.hpp"
#include "overlapping_boxes.hpp"
#include "region_faults.hpp"
#include "segments_apart.hpp"

namespace carom::geometry {

namespace {

/// Is the loop inside `around`? They do not cross, so any point that is not on `around` tells.
bool lies_inside(const Loop& loop, const ExactLoop& around) {
  for (int n = 0; n < 8; ++n)
    for (const NamedCurve& c : loop) {
      const ExactPoint p = sample_point(ExactCurve(c.curve), end_parameter(c.curve), n);
      if (!around.on_boundary(p)) return around.inside(p);
    }
  return false;
}

/// One piece, as itself (copy 0) or repeated by the lattice.
struct Item {
  std::size_t loop, piece, copy;
};

class Check {
 public:
  Check(const std::vector<Loop>& loops, RegionKind kind, const std::optional<Lattice>& lattice,
        std::size_t limit)
      : loops_(loops), kind_(kind), lattice_(lattice), faults_(limit) {}

  std::vector<RegionFault> run() {
    for (const Loop& loop : loops_) check_extent(loop, faults_);
    if (faults_.none())
      for (const Loop& loop : loops_) check_closed(loop, faults_);
    if (faults_.none()) {
      find_boxes();
      if (kind_ == RegionKind::lattice && lattice_ && !loops_.empty()) find_copies();
    }
    if (faults_.none()) {
      place_items();
      meetings();
      if (!faults_.any(Kind::crossing)) orientations();
      if (faults_.none()) nesting();
    }
    return faults_.take();
  }

 private:
  using Kind = RegionFault::Kind;

  void find_boxes() {
    for (const Loop& loop : loops_) loop_boxes_.push_back(whole_of(loop));
    if (!loop_boxes_.empty()) whole_ = hull_of(loop_boxes_);
  }

  void place_items() {
    items_.clear();
    boxes_.clear();
    for (std::size_t copy = 0; copy < copies_.size(); ++copy)
      for (std::size_t l = 0; l < loops_.size(); ++l)
        for (std::size_t p = 0; p < loops_[l].size(); ++p) {
          const Box box = bounding_box(loops_[l][p].curve);
          const Box there = copy == 0 ? box : moved(box, translation(copy));
          if (copy != 0 && !overlap(there, whole_)) continue;
          items_.push_back({l, p, copy});
          boxes_.push_back(there);
        }
  }

  Box whole_of(const Loop& loop) const {
    return hull_of(loop, [](const NamedCurve& c) { return bounding_box(c.curve); });
  }

  Vector translation(std::size_t copy) const { return displacement(*lattice_, copies_[copy]); }

  /// Half of the cells that could bring something of the whole onto itself: c and -c tell the same.
  /// Obstacles that are wide for their cell meet the nearest copies, too: these are asked first, so
  /// that the others need not be counted one by one.
  void find_copies() {
    std::size_t pieces = 0;
    for (const Loop& loop : loops_) pieces += loop.size();
    const std::size_t most = std::clamp<std::size_t>((std::size_t{1} << 20) / pieces, 64, 65536);
    const auto add = [&](const Cell& c) {
      if (c.first < 0 || (c.first == 0 && c.second <= 0)) return;
      if (overlap(moved(whole_, displacement(*lattice_, c)), whole_)) copies_.push_back(c);
    };
    const auto all = cells_that_reach(*lattice_, whole_, whole_, most);
    if (!all || all->size() > 256) {
      for (const CellEdge& e : lattice_->edges) add(e.beyond);
      place_items();
      meetings();
      if (!faults_.none()) return;
      copies_.resize(1);
    }
    if (!all) {
      faults_.add(Kind::crossing, loops_[0][0].name, "", whole_.low,
                  "the obstacles spread over more than " + std::to_string(most) +
                      " cells of the lattice: too many copies could meet");
      return;
    }
    for (const Cell& c : *all) add(c);
  }

  DyadicVector shift(std::size_t copy) const {
    if (copy == 0) return {};
    const Cell c = copies_[copy];
    return Dyadic(static_cast<double>(c.first)) * exact(lattice_->first) +
           Dyadic(static_cast<double>(c.second)) * exact(lattice_->second);
  }

  const ExactLoop& exact_loop(std::size_t loop, std::size_t copy) {
    std::unique_ptr<ExactLoop>& entry = exact_[{loop, copy}];
    if (!entry) entry = std::make_unique<ExactLoop>(loops_[loop], shift(copy));
    return *entry;
  }

  const std::string& name(const Item& i) const { return loops_[i.loop][i.piece].name; }
  bool is_disc(const Item& i) const {
    return std::holds_alternative<Circle>(loops_[i.loop][i.piece].curve);
  }
  bool is_obstacle(const Item& i) const {
    const auto* circle = std::get_if<Circle>(&loops_[i.loop][i.piece].curve);
    return kind_ != RegionKind::bounded || (circle && !circle->counterclockwise);
  }
  std::string quoted(const Item& i) const {
    if (i.copy == 0) return "'" + name(i) + "'";
    const Cell c = copies_[i.copy];
    return "the copy of '" + name(i) + "' in cell (" + std::to_string(c.first) + ", " +
           std::to_string(c.second) + ")";
  }
  void meet(const Item& a, const Item& b, const std::string& verb, Vector place) {
    faults_.add(Kind::crossing, name(a), name(b), place,
                (is_disc(a) && is_disc(b) ? "discs " : "walls ") + quoted(a) + " and " + quoted(b) +
                    " " + verb + " near " + place_text(place));
  }

  bool is_bezier(const Item& i) const {
    return std::holds_alternative<Bezier>(loops_[i.loop][i.piece].curve);
  }
  /// Bézier curves may not even touch themselves or anything else.
  void bezier_with_itself(const Item& i) {
    if (const auto at =
            meeting_with_itself(exact_loop(i.loop, 0).piece(i.piece), loops_[i.loop].size() == 1))
      faults_.add(Kind::crossing, name(i), "", *at,
                  "wall " + quoted(i) + " crosses itself near " + place_text(*at));
  }
  void beziers(const Item& a, const Item& b) {
    const ExactLoop &first = exact_loop(a.loop, a.copy), &second = exact_loop(b.loop, b.copy);
    SharedEnds shared;
    if (a.loop == b.loop && a.copy == b.copy)
      shared = {first.next(a.piece) == b.piece, second.next(b.piece) == a.piece};
    if (const auto at = meeting(first.piece(a.piece), second.piece(b.piece), shared))
      meet(a, b, shared.forth || shared.back ? "meet in a cusp, or again," : "cross or touch", *at);
  }

  void meetings() {
    for (const Item& i : items_)
      if (i.copy == 0 && is_bezier(i)) bezier_with_itself(i);
    overlapping_boxes(boxes_, [&](std::size_t i, std::size_t j) {
      Item a = items_[i], b = items_[j];
      if (a.copy != 0 && b.copy != 0) return !faults_.full();
      if (std::tie(b.copy, b.loop, b.piece) < std::tie(a.copy, a.loop, a.piece)) std::swap(a, b);
      if (is_disc(a) && is_disc(b)) {
        discs(a, b);
      } else if (is_bezier(a) || is_bezier(b)) {
        beziers(a, b);
      } else if (b.copy != 0 ||
                 !segments_apart(loops_[a.loop][a.piece].curve, loops_[b.loop][b.piece].curve)) {
        pieces(a, b);
      }
      return !faults_.full();
    });
  }

  void discs(const Item& a, const Item& b) {
    const Circle& first = std::get<Circle>(loops_[a.loop][a.piece].curve);
    const Circle& second = std::get<Circle>(loops_[b.loop][b.piece].curve);
    ExactCurve moved_second{Curve(second)};
    moved_second.centre = moved_second.centre + shift(b.copy);
    const Discs how = compare_discs(ExactCurve(Curve(first)), moved_second);
    const Vector there = second.centre + (b.copy == 0 ? Vector{} : translation(b.copy));
    const Vector between = there - first.centre;
    const double distance = std::sqrt(dot(between, between));
    // Where the common chord cuts the line of the centres, and half of that chord.
    const double r = first.radius;
    const double share = distance > 0.0 ? 0.5 + 0.5 * (r - second.radius) * (r + second.radius) /
                                                    (distance * distance)
                                        : 0.0;
    const double squared = r * r - share * distance * (share * distance);
    const double half = squared > 0.0 ? std::sqrt(squared) / distance : 0.0;
    const Vector chord = first.centre + share * between;
    if (how == Discs::crossing) {
      if (is_obstacle(a) && is_obstacle(b)) {
        meet(a, b, "overlap", chord);
      } else {
        meet(a, b, "cross", chord + half * left(between));
      }
    }
    if (how == Discs::equal) meet(a, b, "run along each other", start_point(first));
    if ((how == Discs::nested || how == Discs::touching_nested) && is_obstacle(a) &&
        is_obstacle(b)) {
      const bool second_inside = first.radius > second.radius;
      const Item &inner = second_inside ? b : a, &outer = second_inside ? a : b;
      faults_.add(Kind::nesting, name(inner), name(outer), second_inside ? there : first.centre,
                  "obstacle " + quoted(inner) + " lies inside obstacle " + quoted(outer));
    }
  }

  void pieces(const Item& a, const Item& b) {
    const ExactLoop &first = exact_loop(a.loop, a.copy), &second = exact_loop(b.loop, b.copy);
    const bool same_loop = a.loop == b.loop && a.copy == b.copy;
    for (const Contact& c : contacts(first.piece(a.piece), second.piece(b.piece))) {
      if (c.kind == Contact::Kind::together) {
        meet(a, b, "run along each other", c.place);
      } else if (c.kind == Contact::Kind::cross) {
        meet(a, b, "cross", c.place);
      } else if (c.kind == Contact::Kind::touch) {
        if (same_loop) meet(a, b, "of one loop touch", c.place);
      } else if (c.on_first != Where::end && c.on_second != Where::end) {
        // A joint belongs to the wall that begins there, so the joint that neighbours share has
        // been passed over: one of them ends in it.
        if (same_loop) {
          meet(a, b, "of one loop meet", c.place);
        } else {
          at_joint(a, b, first, second, c);
        }
      }
    }
  }

  /// Loops that meet where one of them has a joint may touch, not pass through each other.
  void at_joint(const Item& a, const Item& b, const ExactLoop& first, const ExactLoop& second,
                const Contact& c) {
    const ExactCurve &out_a = first.piece(a.piece).curve(), &out_b = second.piece(b.piece).curve();
    const DyadicVector& at = c.on_first == Where::start ? out_a.from : out_b.from;
    const auto rays = [&](const ExactLoop& loop, std::size_t piece, Where on) {
      const ExactCurve& out = loop.piece(piece).curve();
      const ExactCurve& in = on == Where::start ? loop.piece(loop.previous(piece)).curve() : out;
      return rays_at(in, out, {at.x, at.y, Dyadic(1)});
    };
    const Sign passes =
        pass_through(rays(first, a.piece, c.on_first), rays(second, b.piece, c.on_second));
    if (passes == Sign::positive) meet(a, b, "cross", c.place);
    if (passes == Sign::zero) meet(a, b, "touch with the same tangent and curvature", c.place);
  }

  std::string loop_text(std::size_t loop) const {
    const std::string& wall = loops_[loop][0].name;
    return loops_[loop].size() == 1 ? "'" + wall + "'" : "of wall '" + wall + "'";
  }

  bool counterclockwise(std::size_t loop) {
    const Curve& c = loops_[loop][0].curve;
    if (const auto* circle = std::get_if<Circle>(&c)) return circle->counterclockwise;
    return exact_loop(loop, 0).counterclockwise();
  }

  void orientations() {
    const auto extent_of = [&](std::size_t l) {
      const Vector d = loop_boxes_[l].high - loop_boxes_[l].low;
      return d.x * d.y;
    };
    for (std::size_t l = 0; l < loops_.size(); ++l) {
      if (!counterclockwise(l)) continue;
      if (kind_ == RegionKind::bounded && (!outer_ || extent_of(l) > extent_of(*outer_)))
        outer_ = l;
      turning_left_.push_back(l);
    }
    if (kind_ == RegionKind::bounded && !outer_) {
      std::size_t widest = 0;
      for (std::size_t l = 1; l < loops_.size(); ++l)
        if (extent_of(l) > extent_of(widest)) widest = l;
      if (loops_.empty()) {
        faults_.add(Kind::orientation, "", "", {}, "a bounded region needs an outer loop");
        return;
      }
      const NamedCurve& c = loops_[widest][0];
      faults_.add(
          Kind::orientation, c.name, "", start_point(c.curve),
          "the outer loop " + loop_text(widest) +
              " runs clockwise: it must run counter-clockwise, with the domain on its left");
    }
    for (const std::size_t l : turning_left_) {
      if (outer_ && l == *outer_) continue;
      const NamedCurve& c = loops_[l][0];
      faults_.add(Kind::orientation, c.name, "", start_point(c.curve),
                  "the obstacle " + loop_text(l) +
                      " runs counter-clockwise: an obstacle must run clockwise, with the domain on "
                      "its left");
    }
  }

  void nesting() {
    std::vector<Box> boxes;
    std::vector<std::size_t> whose;
    for (std::size_t l = 0; l < loops_.size() && !faults_.full(); ++l) {
      if (outer_ && l == *outer_) continue;
      boxes.push_back(loop_boxes_[l]);
      whose.push_back(l);
      if (!outer_ || lies_inside(loops_[l], exact_loop(*outer_, 0))) continue;
      const NamedCurve& c = loops_[l][0];
      faults_.add(Kind::nesting, c.name, loops_[*outer_][0].name, start_point(c.curve),
                  "the obstacle " + loop_text(l) + " lies outside the outer loop");
    }
    overlapping_boxes(boxes, [&](std::size_t i, std::size_t j) {
      for (const auto& [inner, outer] : {std::pair{i, j}, std::pair{j, i}}) {
        const std::size_t a = whose[inner], b = whose[outer];
        if (is_disc({a, 0, 0}) && is_disc({b, 0, 0})) continue;  // decided by their distance
        // Boxes are larger than what is in them: whether one is in the other does not tell.
        if (!lies_inside(loops_[a], exact_loop(b, 0))) continue;
        const NamedCurve& c = loops_[a][0];
        faults_.add(Kind::nesting, c.name, loops_[b][0].name, start_point(c.curve),
                    "the obstacle " + loop_text(a) + " lies inside the obstacle " + loop_text(b));
      }
      return !faults_.full();
    });
    // Obstacles wider than the cell could also hold copies of others.
    for (std::size_t copy = 1; copy < copies_.size() && !faults_.full(); ++copy)
      copies_inside(copy);
  }

  void copies_inside(std::size_t copy) {
    const Vector by = translation(copy);
    for (std::size_t a = 0; a < loops_.size(); ++a) {
      if (is_disc({a, 0, 0})) continue;  // discs among themselves: decided by their distance
      for (std::size_t b = 0; b < loops_.size() && !faults_.full(); ++b) {
        if (a == b) continue;
        const Vector back = -by;
        inside_copy(a, b, by, shift(copy));
        inside_copy(a, b, back, -shift(copy));
        if (!is_disc({b, 0, 0})) continue;  // else its own turn comes
        inside_copy(b, a, by, shift(copy));
        inside_copy(b, a, back, -shift(copy));
      }
    }
  }

  void inside_copy(std::size_t inner, std::size_t outer, Vector by, const DyadicVector& exact_by) {
    if (!overlap(loop_boxes_[inner], moved(loop_boxes_[outer], by))) return;
    if (!lies_inside(loops_[inner], ExactLoop(loops_[outer], exact_by))) return;
    const NamedCurve& c = loops_[inner][0];
    faults_.add(Kind::nesting, c.name, loops_[outer][0].name, start_point(c.curve),
                "the obstacle " + loop_text(inner) + " lies inside a copy of the obstacle " +
                    loop_text(outer));
  }

  const std::vector<Loop>& loops_;
  RegionKind kind_;
  const std::optional<Lattice>& lattice_;
  RegionFaults faults_;
  std::vector<Cell> copies_{Cell{}};
  std::vector<Item> items_;
  std::vector<Box> boxes_, loop_boxes_;
  Box whole_;
  std::vector<std::size_t> turning_left_;
  std::optional<std::size_t> outer_;
  std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<ExactLoop>> exact_;
};

}  // namespace

std::vector<RegionFault> check_region(const std::vector<Loop>& loops, RegionKind kind,
                                      const std::optional<Lattice>& lattice, std::size_t limit) {
  return Check(loops, kind, lattice, limit).run();
}

bool lies_inside(const Loop& loop, const Loop& around) {
  return lies_inside(loop, ExactLoop(around, {}));
}

bool runs_counterclockwise(const Loop& loop) {
  if (const auto* circle = std::get_if<Circle>(&loop.front().curve))
    return circle->counterclockwise;
  return ExactLoop(loop, {}).counterclockwise();
}

}  // namespace carom::geometry
