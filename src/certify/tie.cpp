#include "certify/tie.hpp"

#include "carom/base/error.hpp"
#include "carom/table/table.hpp"
#include "certify/flight.hpp"
#include "certify/quadratic.hpp"
#include "certify/start.hpp"
#include "certify/table_builder.hpp"

namespace carom::certify {

template <>
struct Source<Quadratic> {
  static Quadratic value(const ExactNumber& number) { return Quadratic(number); }
  // Twelfths of a turn have roots of 3 at most, eighths of 2.
  static VectorOf<Quadratic> direction(const ExactNumber& angle, long part = 0, long whole = 1) {
    const std::string parts =
        "(" + angle.text() + ")/(2*pi)+" + std::to_string(part) + "/" + std::to_string(whole);
    const auto turns = ExactNumber("(" + parts + ")*24", angle.place()).to_rational();
    if (!turns || turns->denominator != "1") throw NotQuadratic("an angle without a root");
    const mpz_class turned(turns->numerator);
    const unsigned long k = mpz_fdiv_ui(turned.get_mpz_t(), 24);
    return {cosine(k), cosine((k + 18) % 24)};
  }

 private:
  static Quadratic cosine(unsigned long k) {  // of k times 15 degrees
    if (k > 12) k = 24 - k;
    if (k > 6) return -cosine(12 - k);
    const Quadratic half = Quadratic(1) / Quadratic(2);
    switch (k) {
      case 0:
        return Quadratic(1);
      case 2:
        return half * sqrt(Quadratic(3));
      case 3:
        return half * sqrt(Quadratic(2));
      case 4:
        return half;
      case 6:
        return Quadratic(0);
      default:
        throw NotQuadratic("a root of a root");
    }
  }
};

namespace {

using Vector = VectorOf<Quadratic>;
using Wall = WallOf<Quadratic>;

constexpr std::size_t most_bits = 1u << 16;  ///< of one number of a state

bool is_zero(const Quadratic& x) { return sign(x) == Sign::zero; }
bool is_zero(const Vector& v) { return is_zero(v.x) && is_zero(v.y); }

Vector tangent_at(const Wall& w, const Vector& P) {
  if (w.form == Form::segment) return w.chord;
  Vector normal = P - w.centre;
  if (w.form == Form::ellipse) {
    const Quadratic X = dot(normal, w.along), Y = dot(normal, w.across);
    normal = X * w.along + Y * w.across;
  }
  return w.turn > 0 ? left(normal) : -left(normal);
}

class Follower {
 public:
  Follower(const ExactSystem& system, const CertifiedTask& task) : system_(system), task_(task) {
    TableOf<Quadratic> table = TableBuilder<Quadratic>(*system.spec).build();
    scene_.walls = std::move(table.walls);
    scene_.lattice = std::move(table.lattice);
    const ExactStart& start = system.start;
    P_ = {Quadratic(start.position.x), Quadratic(start.position.y)};
    v_ = start.angle ? Source<Quadratic>::direction(*start.angle)
                     : Vector{Quadratic(start.direction.x), Quadratic(start.direction.y)};
    standing_ = start.wall;
    if (standing_ >= 0) P_ = point_with_parameter(wall(standing_), start.u);
    // The speed is that of the direction: only the time is another one.
    scene_.motion.speed2 = dot(v_, v_);
    scene_.motion.inverse_speed2 = Quadratic(1) / scene_.motion.speed2;
  }

  void fly_to(const Copy& copy) {
    const bool same = copy.wall == standing_ && copy.cell == geometry::Cell{};
    const LandingOf<Quadratic> landing =
        fly<Quadratic, Quadratic>(wall(copy.wall), seen(copy), v_, scene_.motion, same);
    P_ = landing.position;
    v_ = landing.velocity;
    time_ = time_ + landing.time;
    standing_ = copy.wall;
    for (const Quadratic* x : {&P_.x, &P_.y, &v_.x, &v_.y, &time_})
      if (x->bits() > most_bits) throw NotQuadratic("long numbers");
  }

  std::optional<Tie> tie(const Doubt& doubt) {
    switch (doubt.kind) {
      case Doubt::choice: {
        const std::optional<Tie> first = with_wall(doubt.first);
        return first || doubt.second.wall < 0 ? first : with_wall(doubt.second);
      }
      case Doubt::hole:
        fly_to(doubt.first);
        return with_hole(doubt.hole_index);
      case Doubt::last_time:
        fly_to(doubt.first);
        break;
    }
    // |v| t / speed, squared.
    const Quadratic way2 = square(time_) * scene_.motion.speed2;
    const Quadratic last = Quadratic(system_.speed) * Quadratic(*task_.t_max);
    if (!is_zero(way2 - square(last))) return std::nullopt;
    return Tie{Tie::last_time, name(standing_) + " is met exactly at the last time: the hit counts"};
  }

 private:
  const Wall& wall(int index) const { return scene_.walls[static_cast<std::size_t>(index)]; }
  std::string name(int index) const {
    return "'" + system_.table->walls[static_cast<std::size_t>(index)].name + "'";
  }
  Vector seen(const Copy& copy) const {
    return copy.cell == geometry::Cell{} ? P_ : P_ - scene_.translation(copy.cell);
  }

  std::optional<Tie> with_wall(const Copy& copy) const {
    const Wall& w = wall(copy.wall);
    const Vector P = seen(copy);
    const bool standing = copy.wall == standing_ && copy.cell == geometry::Cell{};
    if (w.form == Form::segment) {
      for (const Vector* J : {&w.from, &w.to}) {
        const Vector d = *J - P;
        if (is_zero(cross(v_, d)) && sign(dot(v_, d)) == Sign::positive) return at_joint(*J, copy);
      }
      if (is_zero(cross(v_, w.chord)) && is_zero(dot(P - w.from, w.normal)))
        return Tie{Tie::along_wall, "exactly along " + name(copy.wall)};
      return std::nullopt;
    }
    const Vector d = P - w.centre;
    const bool ellipse = w.form == Form::ellipse;
    const Vector e = ellipse ? Vector{dot(d, w.along), dot(d, w.across)} : d;
    const Vector u = ellipse ? Vector{dot(v_, w.along), dot(v_, w.across)} : v_;
    const Quadratic a = dot(u, u), b = dot(e, u);
    if (standing && is_zero(b))
      return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall) + ", on which it lies"};
    const Quadratic c = standing ? Quadratic(0) : dot(e, e) - (ellipse ? Quadratic(1) : w.radius2);
    const Quadratic discriminant = square(b) - a * c;
    if (!standing && is_zero(discriminant)) {
      // From inside a curve it is touched at the point where one stands.
      if (w.turn > 0) return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall)};
      return Tie{Tie::tangency, "exactly tangent to " + name(copy.wall) + ", which is no hit", {copy}};
    }
    if (sign(discriminant) == Sign::negative || w.closed) return std::nullopt;
    for (const Vector* J : {&w.from, &w.to}) {  // on the line of flight, and ahead
      const Vector to = *J - P;
      if (is_zero(cross(v_, to)) && sign(dot(v_, to)) == Sign::positive) return at_joint(*J, copy);
    }
    return std::nullopt;
  }

  std::optional<Tie> at_joint(const Vector& J, const Copy& met) const {
    int ends = -1, begins = -1;
    for (std::size_t k = 0; k < scene_.walls.size(); ++k) {
      if (scene_.walls[k].closed) continue;
      if (is_zero(scene_.walls[k].to - J)) ends = static_cast<int>(k);
      if (is_zero(scene_.walls[k].from - J)) begins = static_cast<int>(k);
    }
    if (ends < 0 || begins < 0) return Tie{Tie::corner, "exactly into an end of " + name(met.wall)};
    const Vector before = tangent_at(wall(ends), J), after = tangent_at(wall(begins), J);
    const std::string walls = name(ends) + " and " + name(begins);
    const Form form_before = wall(ends).form, form_after = wall(begins).form;
    const bool smooth = is_zero(cross(before, after)) && sign(dot(before, after)) == Sign::positive;
    if (smooth) {
      for (const Hole& hole : system_.table->holes)
        if (hole.wall == ends || hole.wall == begins)
          return Tie{Tie::corner, "exactly into the joint between " + walls + ", of which one has a hole"};
      // It leaves the joint from a curve, where there is one: from there a segment beside it is not met.
      const bool from_end = form_after == Form::segment && form_before != Form::segment;
      Tie tie{Tie::reflection, "exactly into the joint between " + walls + ", where they have one tangent"};
      tie.walls = {{from_end ? ends : begins, met.cell}};
      tie.joint = {{ends, met.cell}, {begins, met.cell}};
      const int other = from_end ? begins : ends;
      if (wall(other).form == Form::segment) tie.beside = other;  // a curve may be met elsewhere
      return tie;
    }
    const std::string text = "exactly into the corner between " + walls;
    const int n =
        form_before == Form::segment && form_after == Form::segment ? parts_of_half_turn(before, after) : 0;
    if (n == 0) return Tie{Tie::corner, text};
    // Orbits beside one that meets a hole there leave through it.
    for (const Hole& hole : system_.table->holes)
      if ((hole.wall == ends && hole.to == 1.0) || (hole.wall == begins && hole.from == 0.0))
        return Tie{Tie::corner, text + ", at a hole"};
    // In either order n reflections come to the same.
    Tie tie{Tie::reflection, text + ", whose angle is pi/" + std::to_string(n)};
    tie.joint = {{ends, met.cell}, {begins, met.cell}};
    for (int i = 0; i < n; ++i)
      tie.walls.push_back({i % 2 == 0 ? ends : begins, i == 0 ? met.cell : geometry::Cell{}});
    tie.beside = n % 2 == 0 ? ends : begins;
    return tie;
  }

  // The n of an interior angle pi/n between two walls with these tangents; 0 where it is none of 2, 3, 4, 6.
  static int parts_of_half_turn(const Vector& before, const Vector& after) {
    if (sign(cross(before, after)) != Sign::positive) return 0;
    const Quadratic cosine = -dot(before, after), squares = dot(before, before) * dot(after, after);
    if (is_zero(cosine)) return 2;
    if (sign(cosine) == Sign::negative) return 0;
    const Quadratic four = Quadratic(4) * square(cosine);
    if (is_zero(four - squares)) return 3;
    if (is_zero(four - Quadratic(2) * squares)) return 4;
    return is_zero(four - Quadratic(3) * squares) ? 6 : 0;
  }

  static Tie at_hole(Tie::Kind kind, std::string text, int hole) {
    Tie tie{kind, std::move(text)};
    tie.hole = hole;
    return tie;
  }
  std::string name_of_hole(std::size_t spec) const {
    const std::string& given = system_.spec->holes[spec].name;
    return given.empty() ? "hole_" + std::to_string(spec + 1) : given;
  }
  // Another hole of the same wall, in Table::holes, that starts at this arc length; -1: none.
  int hole_from(const Quadratic& s2, const Quadratic& length2, std::size_t but) const {
    for (std::size_t k = 0; k < system_.spec->holes.size(); ++k) {
      const HoleSpec& spec = system_.spec->holes[k];
      if (k == but || spec.wall != system_.spec->holes[but].wall) continue;
      const Quadratic start = Quadratic(spec.center) - Quadratic(spec.width) / Quadratic(2);
      if (!is_zero(s2 - square(start) * length2)) continue;
      for (std::size_t i = 0; i < system_.table->holes.size(); ++i)
        if (system_.table->holes[i].name == name_of_hole(k)) return static_cast<int>(i);
    }
    return -1;
  }

  // The arc length squared against that of the ends: so it costs no root.
  std::optional<Tie> with_hole(int index) const {
    const Wall& w = wall(standing_);
    if (w.form != Form::segment) return std::nullopt;
    const std::string& called = system_.table->holes[static_cast<std::size_t>(index)].name;
    const std::string hole = " '" + called + "' in " + name(standing_);
    for (std::size_t k = 0; k < system_.spec->holes.size(); ++k) {
      const HoleSpec& spec = system_.spec->holes[k];
      if (name_of_hole(k) != called) continue;
      const Quadratic half = Quadratic(spec.width) / Quadratic(2), centre(spec.center);
      const Quadratic s2 = square(dot(P_ - w.from, w.chord)), length2 = dot(w.chord, w.chord);
      if (is_zero(s2 - square(centre - half) * length2))
        return at_hole(Tie::hole_start, "exactly at the start of hole" + hole + ", which belongs to it", index);
      if (!is_zero(s2 - square(centre + half) * length2)) continue;
      if (const int next = hole_from(s2, length2, k); next >= 0)
        return at_hole(Tie::hole_start, "exactly at the end of hole" + hole + ", where the next one starts", next);
      return at_hole(Tie::hole_end, "exactly at the end of hole" + hole + ", which does not belong to it", index);
    }
    return std::nullopt;
  }

  const ExactSystem& system_;
  const CertifiedTask& task_;
  SceneOf<Quadratic> scene_;
  Vector P_, v_;
  Quadratic time_;
  int standing_ = -1;
};

}  // namespace

class TieFinder::Implementation {
 public:
  Implementation(const ExactSystem& system, const CertifiedTask& task) : system_(system), task_(task) {}

  std::optional<Tie> find(const std::vector<Copy>& path, const Doubt& doubt) {
    if (hopeless_) return std::nullopt;
    const QuadraticField field;
    QuadraticField::radicand() = radicand_;
    try {
      if (!follower_) {
        if (sign(Quadratic(system_.omega)) != Sign::zero) throw NotQuadratic("a field");
        follower_.emplace(system_, task_);
      }
      for (; followed_ < path.size(); ++followed_) follower_->fly_to(path[followed_]);
    } catch (const NotQuadratic&) {
      hopeless_ = true;
      return std::nullopt;
    }
    radicand_ = QuadraticField::radicand();
    try {
      Follower there = *follower_;
      std::optional<Tie> tie = there.tie(doubt);
      if (tie) tie->text = "event " + std::to_string(path.size() + 1) + ": " + tie->text;
      return tie;
    } catch (const NotQuadratic&) {
      return std::nullopt;
    }
  }

 private:
  const ExactSystem& system_;
  const CertifiedTask& task_;
  std::optional<Follower> follower_;
  std::size_t followed_ = 0;
  mpz_class radicand_;
  bool hopeless_ = false;
};

TieFinder::TieFinder(const ExactSystem& system, const CertifiedTask& task)
    : implementation_(std::make_unique<Implementation>(system, task)) {}
TieFinder::~TieFinder() = default;
std::optional<Tie> TieFinder::find(const std::vector<Copy>& path, const Doubt& doubt) {
  return implementation_->find(path, doubt);
}

}  // namespace carom::certify
