// Straight flights in lanes: which piece comes first, by signs with margins, and the hit there. Included
// by kernel.hpp inside the namespace of its instruction set.
//
// Every number that shows in an orbit comes from the operations of the scalar engine in their order; only
// the choice of the piece is made otherwise, and a choice is either certain or left to that engine.
// docs/developer/lanes.md derives the margins.

/// The line of each flight: on which side of it a point lies.
struct Line {
  const View& f;
  Real x, minus_y, offset;  ///< of the velocity, and -(v x origin)
  INLINE explicit Line(const View& view)
      : f(view), x(f.velocity.x), minus_y(-f.velocity.y), offset(-cross(f.velocity, f.origin)) {}
  /// v x (point - origin).
  INLINE Real side(double px, double py) const { return fused(x, Real(py), fused(minus_y, Real(px), offset)); }
  /// v . (point - origin).
  INLINE Real ahead(double px, double py) const {
    return fused(x, Real(px), fused(f.velocity.y, Real(py), -dot(f.velocity, f.origin)));
  }
  /// (A - origin) x (B - origin), the ends of a piece with joints.
  INLINE Real cross_of_ends(const LaneTable& t, int i) const {
    return fused(f.origin.y, Real(t.along_x[i]), fused(f.origin.x, Real(t.back_y[i]), Real(t.turn[i])));
  }
};

/// A convex loop alone: between a joint on the right and the next one on the left, or, with all joints on one
/// side, through the arc that the particle stands on (meet_by_line sees that it is one).
INLINE Choice exit_of_loop(const View& f) {
  const LaneTable& t = f.table;
  if (t.pieces == 1) return {Real(0.0), Mask(true), Real(0.0)};
  Real piece = f.start_piece;
  const Line line(f);
  const Real first = line.side(t.joint_x[0], t.joint_y[0]);
  Real least = first;
  const Mask first_right = first < 0.0;
  Mask right = first_right;
  for (int i = 1; i < t.pieces; ++i) {
    const Real side = line.side(t.joint_x[i], t.joint_y[i]);
    least = least_size(least, side);
    const Mask now = side < 0.0;
    where(right && !now, piece) = Real(counted[i - 1]);
    right = now;
  }
  where(right && !first_right, piece) = Real(counted[t.pieces - 1]);
  return {piece, abs(least) > f.sides && piece >= 0.0, Real(0.0)};
}

/// Any table: the earliest of all exits, and whether it comes certainly first and later than now.
class Earliest {
 public:
  INLINE explicit Earliest(const View& f)
      : decided_(true), piece_(-1.0), best_(never), second_(never), margin_(f.order) {}

  /// After `time`/`unit`.
  INLINE void add(int piece, const Mask& leaves, const Real& time, const Real& unit) {
    Real at = time / unit;
    where(!(leaves && at > -margin_), at) = never;
    second_ = min(second_, max(best_, at));
    where(at < best_, piece_) = Real(counted[piece]);
    best_ = min(best_, at);
  }
  INLINE void doubt(const Mask& where_not) { decided_ = decided_ && !where_not; }
  INLINE Choice choice() const {  // below 0: none
    return {piece_, decided_ && !(best_ <= margin_) && !(second_ - best_ <= margin_), Real(0.0)};
  }

 private:
  static constexpr double never = __builtin_huge_val();
  Mask decided_;
  Real piece_, best_, second_;
  Real margin_;  // of two times
};

INLINE Cut cut_of_circle(const View& f, const Line& line, int i) {
  const LaneTable& t = f.table;
  const Real aside = line.side(t.point_x[i], t.point_y[i]);
  return {-line.ahead(t.point_x[i], t.point_y[i]), f.square_speed, fused(aside, -aside, t.second_number[i] * f.square_speed)};
}

/// A conic or an arc of it, between joints of which each lies on the right of the line or not. A particle leaves by the
/// later cut if the domain is inside, else by the earlier one.
struct SideOfJoint {
  Real side;
  Mask right;
};
INLINE void add_conic(Earliest& best, const View& f, const Line& line, int i, const SideOfJoint* a, const SideOfJoint* b,
                      const Cut& cut) {
  const LaneTable& t = f.table;
  const Mask stands = f.start_wall == Real(t.wall[i]), met = cut.discriminant > f.roots;
  const bool inside = t.orientation[i] > 0.0;
  Mask leaves = inside ? Mask(true) : !stands;
  if (a) {
    // With both joints on one side: if the foot of the centre lies beyond the chord, on the arc's side; or from the arc.
    const Mask same = a->right == b->right;
    const Real foot = fused(cut.square, line.cross_of_ends(t, i), cut.along * (b->side - a->side));
    best.doubt(same && !stands && abs(foot) <= f.roots && cut.discriminant > -f.roots);
    const Mask twice = !stands && (inside ? foot < 0.0 : foot > 0.0), own = f.start_piece == Real(counted[i]);
    leaves = leaves && ((a->right && !b->right) || (same && (inside ? twice || own : twice)));
  }
  best.doubt(leaves && !met && cut.discriminant > -f.roots);
  const Real root = sqrt(max(cut.discriminant, Real(0.0)));
  best.add(i, leaves && met, (inside ? root : -root) - cut.along, cut.square);
}

template <bool ellipses = false>
INLINE Choice first_of_all(const View& f) {
  const LaneTable& t = f.table;
  Earliest best(f);
  const Line line(f);
  const auto cut_of = [&](int i) { return ellipses && t.ellipses.of[i] ? cut_of_ellipse(f, i) : cut_of_circle(f, line, i); };
  Real least(__builtin_huge_val());
  for (int loop = 0; loop < t.loops; ++loop) {
    const int first = t.first[loop], last = first + t.count[loop] - 1;
    if (t.closed[first]) {
      add_conic(best, f, line, first, nullptr, nullptr, cut_of(first));
      continue;
    }
    const auto joint = [&](int i) {
      const Real side = line.side(t.joint_x[i], t.joint_y[i]);
      least = least_size(least, side);
      return SideOfJoint{side, side < 0.0};
    };
    const SideOfJoint start = joint(first);
    SideOfJoint a = start;
    for (int i = first; i <= last; ++i) {
      const SideOfJoint b = i == last ? start : joint(i + 1);
      if (t.bent[i]) {
        add_conic(best, f, line, i, &a, &b, cut_of(i));
      } else {
        const Mask crosses = a.right && !b.right;
        best.add(i, crosses, line.cross_of_ends(t, i), b.side - a.side);
      }
      a = b;
    }
  }
  best.doubt(least <= joint_margin / sign_margin * f.sides);
  return best.choice();
}

/// The duration of the flight to the piece that was chosen: a fraction for either kind of wall.
template <class Kind>
INLINE Where meet_by_line(const View& f, const Met& met) {
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
    decided = met.stands || discriminant > f.roots;
    if constexpr (Kind::segments) decided = decided || !met.bent;
  }
  if constexpr (Kind::segments) {
    const Vector tangent{met.first, met.second};
    const Real across = cross(tangent, e), along = -cross(tangent, v);
    if constexpr (Kind::convex) decided = decided && !(met.stands && !met.bent);
    time = Kind::circles ? choose(met.bent, time, across) : across;
    unit = Kind::circles ? choose(met.bent, unit, along) : along;
  }
  if constexpr (Kind::ellipses) {
    const FractionOfTime to = time_to_ellipse<Kind>(f, e, met.ellipse, met.orientation, met.stands);
    const Mask is = met.ellipse.is;
    if constexpr (Kind::segments || Kind::circles) {
      time = choose(is, to.time, time);
      unit = choose(is, to.unit, unit);
      decided = (is && to.decided) || (!is && decided);
    } else {
      time = to.time;
      unit = to.unit;
      decided = to.decided;
    }
  }
  return {time / unit, decided};
}
