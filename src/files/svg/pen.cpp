#include "files/svg/pen.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::files {
namespace {

using Kind = PieceSpec::Kind;

Rational dot(const DrawnPoint& a, const DrawnPoint& b) { return a.x * b.x + a.y * b.y; }

/// Are all points on the straight line between the ends?
bool is_straight(const DrawnPoint& from, const std::vector<DrawnPoint>& control,
                 const DrawnPoint& to) {
  const DrawnPoint chord = to - from;
  const Rational length = dot(chord, chord);
  return std::all_of(control.begin(), control.end(), [&](const DrawnPoint& p) {
    const DrawnPoint d = p - from;
    const Rational along = dot(d, chord);
    return d.x * chord.y == d.y * chord.x && along >= 0 && along <= length;
  });
}

}  // namespace

ExactPoint Pen::image(const DrawnPoint& p, const Place& place) const {
  const DrawnPoint q = transform_(p);
  return {written(q.x, place), written(q.y, place)};
}

void Pen::finish(bool closed) {
  if (!stroke_.chain.empty()) {
    stroke_.from = transform_(start_);
    stroke_.to = transform_(at_);
    stroke_.closed = closed || stroke_.from == stroke_.to;
    strokes_.push_back(std::move(stroke_));
  }
  stroke_ = {};
  relative_ = 0;
}

void Pen::move(const DrawnPoint& to, const Place& place) {
  finish(false);
  start_ = at_ = low_ = high_ = to;
  written_start_ = written_at_ = image(to, place);
}

void Pen::add(PieceSpec piece, const DrawnPoint& to, const Place& place) {
  if (stroke_.chain.empty()) stroke_.place = place;
  piece.place = place;
  piece.to = to == start_ ? written_start_ : image(to, place);
  stroke_.chain.push_back({"", table::shapes::WrittenPiece{written_at_, piece}});
  written_at_ = std::move(piece.to);
  at_ = to;
  low_ = {std::min(low_.x, to.x), std::min(low_.y, to.y)};
  high_ = {std::max(high_.x, to.x), std::max(high_.y, to.y)};
}

void Pen::line(const DrawnPoint& to, const Place& place) {
  if (to == at_) return;
  add({}, to, place);
}

void Pen::bezier(const std::vector<DrawnPoint>& control, const DrawnPoint& to, const Place& place) {
  if (is_straight(at_, control, to)) return line(to, place);
  PieceSpec piece;
  piece.kind = Kind::bezier;
  for (const DrawnPoint& p : control) piece.control.push_back(image(p, place));
  add(std::move(piece), to, place);
}

// In the frame in which the ellipse is the unit circle the arc bulges from the middle of its chord
// by t chords, t = r/c -+ sqrt((r/c)^2 - 1/4): to the right where it runs towards larger angles.
void Pen::arc(Rational rx, Rational ry, Rational angle, bool large, bool sweep,
              const DrawnPoint& to, const Place& place) {
  rx = abs(rx);
  ry = abs(ry);
  if (to == at_ || rx == 0 || ry == 0) return line(to, place);
  if (rx == ry) angle = 0;
  const Affine frame = turn(angle).after({rx, 0, 0, ry, 0, 0}), seen = frame.inverse();
  const DrawnPoint p = seen(at_), chord = seen(to) - p;
  const Rational ratio = 1 / dot(chord, chord), above = ratio - Rational(1, 4);
  Rational bulge(1, 2);  // a half circle, also where the radii are too short for the chord
  if (above > 0) {
    const double sum = std::sqrt(nearest(ratio)) + std::sqrt(nearest(above));
    if (!(sum < 1e15))
      throw InputError(place, "the arc is too flat", "a straight line, or a smaller radius");
    bulge = Rational(large ? sum : 0.25 / sum);
  }
  const Rational right = sweep ? bulge : Rational(-bulge);
  const DrawnPoint via{p.x + chord.x / 2 + right * chord.y, p.y + chord.y / 2 - right * chord.x};
  const Axes axes = axes_of(transform_.after(frame), place);
  PieceSpec piece;
  piece.kind = axes.circle() ? Kind::arc : Kind::ellipse;
  piece.via = image(frame(via), place);
  if (!axes.circle()) {
    const bool first = axes.square_a > axes.square_b;
    piece.ratio =
        written_root(first ? axes.square_b / axes.square_a : axes.square_a / axes.square_b, place);
    piece.angle = first ? axes.angle : ExactNumber("pi/2", place);
  }
  add(std::move(piece), to, place);
}

void Pen::ellipse(const DrawnPoint& centre, const Rational& rx, const Rational& ry,
                  const Place& place) {
  using namespace table::shapes;
  const Axes axes = axes_of(transform_.after({rx, 0, 0, ry, 0, 0}), place);
  const ExactPoint middle = image(centre, place);
  const ExactNumber a = written_root(axes.square_a, place);
  Stroke stroke;
  stroke.closed = true;
  stroke.place = place;
  if (axes.circle()) {
    stroke.chain = {{"", WrittenCircle{middle, a, true}}};
  } else {
    const ExactNumber b = written_root(axes.square_b, place);
    stroke.chain = {{"", WrittenEllipse{middle, a, b, axes.angle, true}}};
  }
  strokes_.push_back(std::move(stroke));
}

// Drawing programs round the numbers that they write, and relative ends add up. A gap of that size
// which is far smaller than the whole is no side.
bool Pen::closes_by_rounding() const {
  if (decimals_ < 1) return false;
  mpz_class unit;
  mpz_ui_pow_ui(unit.get_mpz_t(), 10, static_cast<unsigned long>(decimals_));
  const Rational most = Rational(relative_ + 1) / unit,
                 size = std::max(high_.x - low_.x, high_.y - low_.y);
  const Rational gap = std::max(abs(Rational(at_.x - start_.x)), abs(Rational(at_.y - start_.y)));
  return gap <= most && gap * 1000 < size;
}

void Pen::close(const Place& place) {
  if (!stroke_.chain.empty() && !(at_ == start_)) {
    if (closes_by_rounding()) {
      std::get<table::shapes::WrittenPiece>(stroke_.chain.back().curve).piece.to = written_start_;
    } else {
      line(start_, place);
    }
  }
  at_ = start_;
  written_at_ = written_start_;
  finish(true);
  low_ = high_ = start_;
}

std::vector<Stroke> Pen::strokes() {
  finish(false);
  return std::move(strokes_);
}

}  // namespace carom::files
