// Straight flights in lanes: which piece comes first, by signs with margins, and the hit there. Included
// by kernel.hpp inside the namespace of its instruction set.
//
// Every number that shows in an orbit comes from the operations of the scalar engine in their order; only
// the choice of the piece is made otherwise, and a choice is either certain or left to that engine.
// docs/developer/lanes.md derives the margins.

/// A convex loop alone: between a joint on the right and the next one on the left, or, with all joints on one
/// side, through the arc that the particle stands on (meet_by_line sees that it is one).
INLINE Choice exit_of_loop(const View& f) {
  const LaneTable& t = f.table;
  if (t.pieces == 1) return {Real(0.0), Mask(true), Real(0.0)};
  Real piece = f.start_piece;
  const auto side_of = [&](int i) {
    return cross(f.velocity, Vector{t.joint_x[i] - f.origin.x, t.joint_y[i] - f.origin.y});
  };
  const Real first = side_of(0);
  Real least = abs(first), before = first;
  for (int i = 1; i < t.pieces; ++i) {
    const Real side = side_of(i);
    least = min(least, abs(side));
    where(before < 0.0 && side >= 0.0, piece) = Real(i - 1.0);
    before = side;
  }
  where(before < 0.0 && first >= 0.0, piece) = Real(t.pieces - 1.0);
  return {piece, least > (sign_margin * t.size) * f.speed && piece >= 0.0, Real(0.0)};
}

/// Any table: the earliest of all exits, compared as fractions.
class Earliest {
 public:
  explicit Earliest(const View& f)
      : decided_(true),
        piece_(-1.0),
        time_(1.0),
        unit_(0.0),
        sides_((sign_margin * f.table.size) * f.speed),
        squares_((sign_margin * f.table.size) * f.table.size),
        roots_(sides_ * f.table.size * f.speed),
        times_((order_margin * f.table.size) * f.table.size * f.table.size * f.speed) {}

  /// `time`/`unit`, of the sizes size^2 and size * speed.
  INLINE void add(int piece, const Mask& leaves, const Real& time, const Real& unit) {
    // The first one meets 1/0: never later.
    const Real gap = time * unit_ - time_ * unit;
    const Mask better = leaves && gap < 0.0;
    decided_ = decided_ && (!leaves || abs(gap) > times_ || piece_ < 0.0);
    where(better, time_) = time;
    where(better, unit_) = unit;
    where(better, piece_) = Real(static_cast<double>(piece));
  }
  INLINE void doubt(const Mask& where_not) { decided_ = decided_ && !where_not; }
  INLINE Choice choice() const { return {piece_, decided_, Real(0.0)}; }  // below 0: none
  const Real& sides() const { return sides_; }
  const Real& squares() const { return squares_; }
  const Real& roots() const { return roots_; }

 private:
  Mask decided_;
  Real piece_, time_, unit_;
  Real sides_, squares_, roots_, times_;  // margins
};

struct JointOfLine {
  Vector from;  ///< seen from the particle
  Real side;
};

INLINE void add_circle(Earliest& best, const View& f, int i, const JointOfLine* a, const JointOfLine* b) {
  const LaneTable& t = f.table;
  const Vector e = f.origin - Vector{Real(t.point_x[i]), Real(t.point_y[i])};
  const Real p = dot(e, e) - t.second_number[i], q = dot(e, f.velocity);
  const Real discriminant = q * q - p * f.square_speed;
  const Mask stands = f.start_wall == Real(t.wall[i]);
  Mask leaves(true);
  if (a) {
    const Mask right_a = a->side < 0.0, right_b = b->side < 0.0;
    const Mask once = right_a && !right_b, same = right_a == right_b;
    const Real foot = f.square_speed * cross(a->from, b->from) + q * (b->side - a->side);
    const Mask twice = same && !stands && t.orientation[i] * foot < 0.0;
    best.doubt(same && !stands && abs(foot) <= best.roots() && discriminant > -best.roots());
    leaves = once || twice || (same && f.start_piece == Real(static_cast<double>(i)));
  }
  if (t.orientation[i] < 0.0) {
    leaves = leaves && !stands && discriminant > -best.roots() && q < best.sides() && p > -best.squares();
    const Mask certain = discriminant > best.roots() && q < -best.sides() && p > best.squares();
    best.doubt(leaves && !certain);
    best.add(i, leaves && certain, p, sqrt(max(discriminant, Real(0.0))) - q);
  } else {
    const Mask missed = a ? (!stands && discriminant < -best.roots()) : Mask(false);
    const Mask behind = q > best.sides() && p > best.squares();
    leaves = leaves && !missed && (stands || !behind);
    const Mask certain = stands || (discriminant > best.roots() && (q < -best.sides() || p < -best.squares()));
    best.doubt(leaves && !certain);
    Real root = sqrt(max(discriminant, Real(0.0)));
    where(stands, root) = abs(q);
    const Real n = abs(q) + root;
    const Mask away = q >= 0.0 && !stands;
    const Real scale = t.size / f.speed;
    best.add(i, leaves && certain, choose(away, -p, scale * n), choose(away, n, scale * f.square_speed));
  }
}

INLINE Choice first_of_all(const View& f) {
  const LaneTable& t = f.table;
  Earliest best(f);
  for (int loop = 0; loop < t.loops; ++loop) {
    const int first = t.first[loop], last = first + t.count[loop] - 1;
    if (t.closed[first]) {
      add_circle(best, f, first, nullptr, nullptr);
      continue;
    }
    const auto joint = [&](int i) {
      const Vector d = Vector{Real(t.joint_x[i]), Real(t.joint_y[i])} - f.origin;
      const Real side = cross(f.velocity, d);
      best.doubt(abs(side) <= best.sides());
      return JointOfLine{d, side};
    };
    const JointOfLine start = joint(first);
    JointOfLine a = start;
    for (int i = first; i <= last; ++i) {
      const JointOfLine b = i == last ? start : joint(i + 1);
      if (t.bent[i]) {
        add_circle(best, f, i, &a, &b);
      } else {
        const Mask crosses = a.side < 0.0 && b.side > 0.0;
        const Real time = cross(a.from, b.from);
        best.doubt(crosses && abs(time) <= best.squares());
        best.add(i, crosses && time > 0.0, time, b.side - a.side);
      }
      a = b;
    }
  }
  return best.choice();
}

/// The flight to the piece that was chosen: a fraction for either kind of wall.
template <class Kind>
INLINE Meeting meet_by_line(const View& f, const Met& met) {
  const LaneTable& t = f.table;
  const Vector e = f.origin - met.point, v = f.velocity;
  Real time, unit;
  Mask decided(true);
  if constexpr (Kind::circles) {
    Real a = dot(e, e) - met.second;
    const Real b = dot(e, v);
    const Real discriminant = b * b - a * f.square_speed;
    Real root = sqrt(max(discriminant, Real(0.0)));
    where(met.stands, a) = Real(0.0);
    where(met.stands, root) = abs(b);
    const Real n = abs(b) + root;
    const Mask away = -met.orientation * b <= 0.0;
    time = choose(away, -met.orientation * a, n);
    unit = choose(away, n, met.orientation * f.square_speed);
    decided = met.stands || discriminant > (sign_margin * t.size * t.size) * f.square_speed;
    if constexpr (Kind::segments) decided = decided || !met.bent;
  }
  if constexpr (Kind::segments) {
    const Vector tangent{met.first, met.second};
    const Real across = cross(tangent, e), along = -cross(tangent, v);
    if constexpr (Kind::convex) decided = decided && !(met.stands && !met.bent);
    time = Kind::circles ? choose(met.bent, time, across) : across;
    unit = Kind::circles ? choose(met.bent, unit, along) : along;
  }
  const Real duration = time / unit;
  decided = decided && duration > 0.0 && duration < __builtin_huge_val();
  return {f.origin + duration * v, v, duration, decided};
}
