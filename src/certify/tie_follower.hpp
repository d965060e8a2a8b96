// An orbit in exact numbers, over walls that balls have proven, and the tie at its next event.
#pragma once

#include <optional>
#include <string>

#include "certify/tie.hpp"
#include "certify/tie_numbers.hpp"

namespace carom::certify {

/// Every function throws NotQuadratic where a number is not of the form a + b sqrt(d), or too long.
class TieFollower {
 public:
  TieFollower(const ExactSystem&, const CertifiedTask&);

  void fly_to(const Copy&);
  /// The tie at the next event, which may fly there.
  std::optional<Tie> tie(const Doubt&);

 private:
  using Vector = VectorOf<Quadratic>;
  using Wall = WallOf<Quadratic>;

  /// Where the line or circle of flight passes an end of a wall, and with which velocity.
  struct Passing {
    Vector end, velocity;
  };
  std::optional<Tie> with_wall(const Copy&) const;
  std::optional<Tie> touching_straight(const Wall&, const Vector& P, const Copy&, bool standing) const;
  std::optional<Tie> touching_in_field(const Wall&, const Vector& P, const Copy&, bool standing) const;
  std::optional<Passing> joint_ahead(const Wall&, const Vector& P) const;
  std::optional<Tie> at_joint(const Passing&, const Copy& met) const;
  bool opens_at(int wall, bool at_its_end) const;
  std::optional<Tie> with_hole(int hole) const;
  bool is_at(const HoleSpec&, int side) const;
  std::optional<Vector> end_of_hole(const HoleSpec&, int side) const;
  std::optional<Tie> with_last_time() const;

  bool turns() const { return scene_.motion.turns; }
  /// The velocity where the Larmor circle has come to P + d.
  Vector velocity_after(const Vector& d) const;
  const Wall& wall(int index) const { return scene_.walls[static_cast<std::size_t>(index)]; }
  std::string name(int index) const {
    return "'" + system_.table->walls[static_cast<std::size_t>(index)].name + "'";
  }
  Vector seen(const Copy& copy) const {
    return copy.cell == geometry::Cell{} ? P_ : P_ - scene_.translation(copy.cell);
  }

  const ExactSystem& system_;
  const CertifiedTask& task_;
  SceneOf<Quadratic> scene_;
  Vector P_, v_;
  Quadratic time_;              ///< without field
  Vector turned_{1, 0};         ///< by flights in a field, in their sense: cosine and sine
  long whole_turns_ = 0;        ///< besides
  int standing_ = -1;
};

}  // namespace carom::certify
