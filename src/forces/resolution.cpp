#include "forces/resolution.hpp"

#include <bit>
#include <cmath>

#include "carom/base/elementary.hpp"

namespace carom {

using geometry::Vector;

namespace {

/// The smallest e with 2^e > x, for positive normal numbers.
int exponent_above(double x) { return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ff) - 1022; }
double power_of_two(int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); }

constexpr int least_exponent = -1000, most_exponent = 1000;
/// The grid's mesh is a quarter of the displacements that its bounds are for.
constexpr int mesh_below_rho = 2;
constexpr std::size_t first_size = 256, most_entries = std::size_t{1} << 20;

/// Of the cell i, j of the grid of an exponent; 0 where the numbers do not fit.
std::uint64_t key_of(int exponent, double i, double j) {
  constexpr double most = 0x1p25;
  if (!(std::fabs(i) < most && std::fabs(j) < most)) return 0;
  const auto bits = [](double k) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(k)) & 0x3ffffff; };
  return static_cast<std::uint64_t>(exponent + 1024) << 52 | bits(i) << 26 | bits(j);
}
std::size_t slot_of(std::uint64_t key, std::size_t size) {
  return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15ull >> 32) & (size - 1);
}

}  // namespace

double resolution::growth(double omega, double time) {
  const double turn = std::fabs(omega) * time;
  return turn > 0.0 ? elementary::exp(turn) : 1.0;
}

ForceBound ForceMap::compute(int exponent, double i, double j) const {
  const double mesh = power_of_two(exponent - mesh_below_rho);
  const Vector low{i * mesh, j * mesh};
  ForceBound bound =
      forces_.external_bound(kind_, {low, low + Vector{mesh, mesh}, power_of_two(exponent)});
  bound.force /= kind_.mass;
  bound.jump /= kind_.mass;
  return bound;
}

ForceBound ForceMap::at(Vector x, int exponent) {
  const double over = power_of_two(mesh_below_rho - exponent);
  const double i = std::floor(x.x * over), j = std::floor(x.y * over);
  const std::uint64_t key = key_of(exponent, i, j);
  if (key == 0) return compute(exponent, i, j);
  if (2 * (used_ + 1) > entries_.size()) grow();
  std::size_t slot = slot_of(key, entries_.size());
  for (; entries_[slot].key != 0; slot = (slot + 1) & (entries_.size() - 1))
    if (entries_[slot].key == key) return entries_[slot].bound;
  entries_[slot] = {key, compute(exponent, i, j)};
  ++used_;
  return entries_[slot].bound;
}

void ForceMap::grow() {
  std::vector<Entry> old = std::move(entries_);
  const bool anew = old.size() >= most_entries;  // it is a store only: begin again rather than fill the memory
  entries_.assign(old.empty() ? first_size : anew ? old.size() : 2 * old.size(), {});
  used_ = 0;
  if (anew) return;
  for (const Entry& e : old) {
    if (e.key == 0) continue;
    std::size_t slot = slot_of(e.key, entries_.size());
    while (entries_[slot].key != 0) slot = (slot + 1) & (entries_.size() - 1);
    entries_[slot] = e;
    ++used_;
  }
}

ForceBound ForceMap::about(Vector x, double rho) {
  const int e = rho > 0.0 ? exponent_above(rho) : least_exponent;
  if (e < least_exponent || e > most_exponent || !std::isfinite(x.x) || !std::isfinite(x.y))
    return {std::numeric_limits<double>::infinity(), 0.0};
  return at(x, e);
}

bool ForceMap::resolves(Vector x, double speed, double way, double time) {
  const double growth = resolution::growth(kind_.omega, time);
  const double jumps = resolution::steps_a_radius * time;
  const auto stays_within = [&](int e) {
    if (e < least_exponent || e > most_exponent) return false;
    const double rho = power_of_two(e);
    if (!(growth * speed * time < rho)) return false;
    const ForceBound bound = at(x, e);
    return resolution::stays(speed, bound.force, time, growth, rho) &&
           (bound.jump == 0.0 || bound.jump * jumps <= resolution::kick_share * speed);
  };
  if (!(std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(way) && std::isfinite(growth))) return false;
  const double least = growth * std::max(way, speed * time);
  if (least > 0x1p-900) {
    const int e = exponent_above(least);
    for (const int more : {1, 2, 0, 3, 4, 5, 6})
      if (stays_within(e + more)) return true;
    return false;
  }
  // At rest where no force acts, as at an equilibrium, any displacement may serve.
  for (int e = 40; e > -80; --e)
    if (stays_within(e)) return true;
  return false;
}

ForceMap& ForceMaps::of(const Particle& kind) {
  for (const auto& map : maps_)
    if (map->kind().mass == kind.mass && map->kind().charge == kind.charge && map->kind().omega == kind.omega)
      return *map;
  return *maps_.emplace_back(std::make_unique<ForceMap>(forces_, kind));
}

}  // namespace carom
