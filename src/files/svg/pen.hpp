// What the elements of a drawing trace: lines, arcs and Bézier curves under a transform.
#pragma once

#include <vector>

#include "files/svg/affine.hpp"
#include "table/shapes.hpp"

namespace carom::files {

/// Curves of which each begins where the one before ended. Names are empty.
struct Stroke {
  table::shapes::Chain chain;
  DrawnPoint from, to;  ///< of the whole, transformed
  bool closed = false;
  Place place;
};

class Pen {
 public:
  explicit Pen(Affine transform) : transform_(std::move(transform)) {}

  const DrawnPoint& at() const { return at_; }
  /// Ends what was drawn so far.
  void move(const DrawnPoint& to, const Place&);
  void line(const DrawnPoint& to, const Place&);
  /// One or two control points. A curve that is a straight line becomes one.
  void bezier(const std::vector<DrawnPoint>& control, const DrawnPoint& to, const Place&);
  /// In the words of SVG; degrees.
  void arc(Rational rx, Rational ry, Rational angle, bool large, bool sweep, const DrawnPoint& to,
           const Place&);
  /// Back to the start: by a straight line, unless the gap is one of rounding. Ends what was drawn.
  void close(const Place&);
  /// A whole ellipse by itself.
  void ellipse(const DrawnPoint& centre, const Rational& rx, const Rational& ry, const Place&);
  /// The numbers have this many digits behind the point, and one more end is relative to another:
  /// by so much rounding may separate the end from the start.
  void set_decimals(long decimals) { decimals_ = decimals; }
  void count_relative() { ++relative_; }

  /// All that was drawn.
  std::vector<Stroke> strokes();

 private:
  ExactPoint image(const DrawnPoint&, const Place&) const;
  void add(PieceSpec, const DrawnPoint& to, const Place&);
  bool closes_by_rounding() const;
  void finish(bool closed);

  Affine transform_;
  DrawnPoint start_, at_;  ///< before the transform
  DrawnPoint low_, high_;  ///< of the ends so far
  ExactPoint written_start_, written_at_;
  Stroke stroke_;
  std::vector<Stroke> strokes_;
  long decimals_ = 0, relative_ = 0;
};

/// Draws the data of a path.
void draw_path(const XmlAttribute& data, const Locator&, Pen&);

}  // namespace carom::files
