#include "carom/forces/force_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "forces/nearest_copy.hpp"
#include "forces/potential.hpp"

namespace carom {

using namespace forces;
using geometry::Vector;

ForceField::ForceField() = default;
ForceField::~ForceField() = default;

double ForceField::add_external(const Particle& p, Vector x, Vector& force) const {
  double value = 0.0;
  for (const auto& potential : potentials_) value += potential->add_force(p, x, force);
  return value;
}

double ForceField::add_pair(const Particle& a, const Particle& b, Vector separation,
                            Vector& force) const {
  return interaction_ ? interaction_->add_force(a, b, separation, force) : 0.0;
}

void ForceField::add_external_hessian(const Particle& p, Vector x, Hessian& hessian) const {
  for (const auto& potential : potentials_) potential->add_hessian(p, x, hessian);
}

void ForceField::add_pair_hessian(const Particle& a, const Particle& b, Vector separation,
                                  Hessian& hessian) const {
  if (interaction_) interaction_->add_hessian(a, b, separation, hessian);
}

ForceBound ForceField::external_bound(const Particle& p, const Neighbourhood& n) const {
  ForceBound sum;
  for (const auto& potential : potentials_) sum += potential->bound(p, n);
  return sum;
}

ForceBound ForceField::pair_bound(const Particle& a, const Particle& b, double distance,
                                  double rho) const {
  return interaction_ ? interaction_->bound(a, b, distance, rho) : ForceBound{};
}

void ForceField::add_pairs(std::span<const Particle> particles, std::span<const Vector> x,
                           const geometry::Lattice* lattice, std::span<Vector> force,
                           base::Interrupt* interrupt) const {
  if (interaction_) interaction_->add_forces(particles, x, lattice, force, interrupt);
}

double ForceField::pair_energy(std::span<const Particle> particles, std::span<const Vector> x,
                               const geometry::Lattice* lattice, base::Interrupt* interrupt) const {
  return interaction_ ? interaction_->energy(particles, x, lattice, interrupt) : 0.0;
}

double ForceField::potential_energy(std::span<const Particle> particles, std::span<const Vector> x,
                                    const geometry::Lattice* lattice) const {
  double sum = 0.0;
  Vector unused{};
  if (external())
    for (std::size_t i = 0; i < x.size(); ++i) sum += add_external(particles[i], x[i], unused);
  return sum + pair_energy(particles, x, lattice);
}

namespace {

void check(const PotentialSpec& s, const std::vector<Particle>& particles, bool lattice) {
  using Kind = PotentialSpec::Kind;
  if (s.lattice && !lattice)
    throw InputError(s.place, "the potential is to be repeated on a lattice, but there is none",
                     "[lattice] vectors, or lattice = false");
  if (s.lattice && s.kind != Kind::fermi && s.kind != Kind::gaussian)
    throw InputError(s.place, "only potentials that fall off fast can be summed over a lattice",
                     "kind = \"fermi\" or \"gaussian\"");
  if (s.kind != Kind::coulomb) return;
  for (const Particle& p : particles)
    if (p.charge * s.charge < 0.0)
      throw InputError(
          s.place,
          "the Coulomb centre attracts: a particle that falls into it has no energy bound and no "
          "step is short enough",
          "charges of the same sign, or a soft potential (gaussian with height < 0)");
}

/// Do the discs of this radius about the lattice points cover the plane?
bool covers(const geometry::Lattice& lattice, double radius) {
  Vector middle{};
  for (const geometry::CellEdge& e : lattice.edges) middle = middle + e.segment.from;
  middle = (1.0 / static_cast<double>(lattice.edges.size())) * middle;
  return std::all_of(lattice.edges.begin(), lattice.edges.end(), [&](const geometry::CellEdge& e) {
    const Vector d = e.segment.from - middle;
    return dot(d, d) <= radius * radius;
  });
}

/// The shortest vector of the lattice, which is one of those over an edge of the cell.
double shortest_period(const geometry::Lattice& lattice) {
  double square = std::numeric_limits<double>::infinity();
  for (const geometry::CellEdge& e : lattice.edges) {
    const Vector across = lattice.translation(e.beyond);
    square = std::min(square, dot(across, across));
  }
  return std::sqrt(square);
}

/// Supports none of which lies in another, but together they cover all. Edges that lie on one
/// another, or within rounding, could not be distinguished by a flight: what sticks out of another
/// support by less than a millionth of its radius makes that one larger instead, which is as right.
std::vector<Support> outermost(const std::vector<Support>& all,
                               const std::optional<geometry::Lattice>& lattice) {
  const auto takes_in = [&](Support& large, const Support& small) {
    Vector d = small.center - large.center;
    if (lattice) d = nearest_copy(d, *lattice);
    const double needed = std::sqrt(dot(d, d)) + small.radius;
    if (needed > large.radius * (1.0 + 0x1p-20)) return false;
    large.radius = std::max(large.radius, needed);
    return true;
  };
  std::vector<Support> found;
  for (Support s : all) {
    if (std::any_of(found.begin(), found.end(), [&](Support& other) { return takes_in(other, s); }))
      continue;
    std::erase_if(found, [&](const Support& other) { return takes_in(s, other); });
    found.push_back(s);
  }
  return found;
}

/// Pairs feel their nearest copies alone: all others must be out of range.
void check_range(const InteractionSpec& s, double range, const geometry::Lattice& lattice) {
  if (!std::isfinite(range))
    throw InputError(s.place,
                     "this interaction reaches infinitely far, which a lattice has no sum for",
                     "yukawa, lennard-jones or soft-sphere");
  const double half = 0.5 * shortest_period(lattice);
  if (range > half)
    throw InputError(
        s.place,
        fmt::format(
            "the interaction reaches {:.4g}, further than half the lattice's shortest period, "
            "{:.4g}: a particle would feel several copies of another",
            range, half),
        "a shorter range, or longer lattice vectors");
}

// Is it the same in all directions about its centre?
bool is_isotropic(const PotentialSpec& s) {
  using Kind = PotentialSpec::Kind;
  switch (s.kind) {
    case Kind::harmonic:
      return s.omega_x == s.omega_y;
    case Kind::fermi:
    case Kind::gaussian:
    case Kind::quartic:
    case Kind::power:
    case Kind::coulomb:
    case Kind::soft_circle:
      return !s.lattice && s.centers.size() == 1;
    default:
      return false;
  }
}

/// Is there a pair whose charges and strength have a negative product?
bool attract(const std::vector<Particle>& particles, double strength) {
  const auto positive = std::count_if(particles.begin(), particles.end(),
                                      [](const Particle&p) { return p.charge > 0.0; }),
             negative = std::count_if(particles.begin(), particles.end(),
                                      [](const Particle&p) { return p.charge < 0.0; });
  return strength > 0.0 ? positive > 0 && negative > 0
                        : strength < 0.0 && (positive > 1 || negative > 1);
}

}  // namespace

std::shared_ptr<const ForceField> ForceField::build(
    const ForceSpec& spec, const std::vector<Particle>& particles,
    const std::optional<geometry::Lattice>& lattice) {
  auto field = std::make_shared<ForceField>();
  field->spec_ = spec;
  for (const PotentialSpec& s : spec.potentials) {
    check(s, particles, lattice.has_value());
    field->potentials_.push_back(make_potential(s, lattice));
    const Potential& p = *field->potentials_.back();
    field->typed_ = field->typed_ || s.kind == PotentialSpec::Kind::expression;
    field->tail_bound_ = std::max(field->tail_bound_, p.tail());
    field->harmonic_ = field->harmonic_ && s.kind == PotentialSpec::Kind::harmonic;
    if (!field->middle_ && s.centers.size() == 1) field->middle_ = s.centers.front();
    field->isotropic_ = field->isotropic_ && is_isotropic(s) && field->middle_ == s.centers.front();
    // On a lattice a potential that is not repeated would depend on the cell.
    if (lattice && !s.lattice)
      throw InputError(s.place, "on a lattice every potential has to be repeated",
                       "lattice = true");
    if (!std::isfinite(p.reach()) || (lattice && covers(*lattice, p.reach())))
      field->everywhere_ = true;
    for (const Vector& center : s.centers) field->supports_.push_back({center, p.reach()});
  }
  if (spec.interaction) {
    const InteractionSpec& s = *spec.interaction;
    if (s.kind == InteractionSpec::Kind::hard_discs) {
      field->disc_radii_ = s.radii;
    } else if (particles.size() > 1) {
      if ((s.kind == InteractionSpec::Kind::coulomb || s.kind == InteractionSpec::Kind::yukawa) &&
          attract(particles, s.strength))
        throw InputError(s.place, "the particles attract each other without bound",
                         "charges of one sign and strength > 0");
      field->interaction_ = make_interaction(s);
      field->pair_range_ = field->interaction_->reach();
      // The Yukawa tail is that of unit charges.
      double charge = 1.0;
      for (const Particle& p : particles)
        if (s.kind == InteractionSpec::Kind::yukawa) charge = std::max(charge, std::fabs(p.charge));
      field->tail_bound_ =
          std::max(field->tail_bound_, charge * charge * field->interaction_->tail());
      if (lattice) check_range(s, field->pair_range_, *lattice);
    }
  }
  if (field->everywhere_)
    field->supports_.clear();
  else
    field->supports_ = outermost(field->supports_, lattice);
  return field;
}

}  // namespace carom
