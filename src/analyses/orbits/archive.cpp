#include "carom/analyses/orbits.hpp"

#include <span>
#include <vector>

#include "carom/base/error.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

namespace {

constexpr const char* orbit_archive_kind = "orbit";
constexpr std::int32_t no_index = -1;

// What an orbit and a hit hold in another form.
struct OrbitExtra {
  std::int32_t hits = 0, maslov = no_index;
  double real = 0.0, imaginary = 0.0;
};
struct HitExtra {
  std::int32_t orbit = 0;
  double half_turn = 0.0;
};

struct ProofColumn {
  const char* name;
  std::string ProofOfOrbit::*value;
  hdf5::Description what;
};
constexpr ProofColumn proof_columns[] = {
    {"reason", &ProofOfOrbit::reason, {"", "Why there is no proof"}},
    {"period", &ProofOfOrbit::period, {"time", "Period"}},
    {"length", &ProofOfOrbit::length, {"length", "Length"}},
    {"trace", &ProofOfOrbit::trace, {"1", "Trace of the tangent map"}},
    {"multiplier", &ProofOfOrbit::multiplier, {"1", "Its larger eigenvalue, if that is real"}}};

// Hits of all orbits, one after the other.
struct FlatHits {
  std::vector<OrbitHit> hits;
  std::vector<HitExtra> extras;
};
FlatHits flat(const std::vector<PeriodicOrbit>& orbits) {
  FlatHits all;
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    const PeriodicOrbit& o = orbits[i];
    all.hits.insert(all.hits.end(), o.hits.begin(), o.hits.end());
    for (const double turn : o.half_turns)
      all.extras.push_back({static_cast<std::int32_t>(i), turn});
  }
  return all;
}

std::vector<OrbitExtra> extras_of(const std::vector<PeriodicOrbit>& orbits) {
  std::vector<OrbitExtra> extras;
  for (const PeriodicOrbit& o : orbits)
    extras.push_back({static_cast<std::int32_t>(o.hits.size()), o.maslov.value_or(no_index),
                      o.multipliers[0].real(), o.multipliers[0].imag()});
  return extras;
}

void write_proofs(const ArchiveFile& file, const ProofsOfOrbits& proofs) {
  const std::string& name = file.name();
  std::vector<std::int32_t> proven, orbit;
  std::vector<std::string> x, y;
  for (std::size_t i = 0; i < proofs.orbits.size(); ++i) {
    const ProofOfOrbit& one = proofs.orbits[i];
    proven.push_back(one.proven);
    orbit.insert(orbit.end(), one.x.size(), static_cast<std::int32_t>(i));
    x.insert(x.end(), one.x.begin(), one.x.end());
    y.insert(y.end(), one.y.begin(), one.y.end());
  }
  const Handle group = file.group("proofs", "Proofs of the rows of /orbits, in decimals");
  const hid_t to = group.get();
  hdf5::write_attribute(to, "digits", std::int64_t{proofs.digits}, name);
  hdf5::write_column<std::int32_t>(to, "proven", proven, {"1", "1: the orbit exists"}, name);
  for (const auto& [column, field, what] : proof_columns) {
    std::vector<std::string> texts;
    for (const ProofOfOrbit& one : proofs.orbits) texts.push_back(one.*field);
    hdf5::write_texts(to, column, texts, what, name);
  }
  const Handle hits = file.group("proof_hits", "Proven positions of hits, orbit after orbit");
  hdf5::write_column<std::int32_t>(hits.get(), "orbit", orbit, {"1", "Row of /proofs"}, name);
  hdf5::write_texts(hits.get(), "x", x, {"length", "Position, in the home cell"}, name);
  hdf5::write_texts(hits.get(), "y", y, {"length", "Position, in the home cell"}, name);
}

ProofsOfOrbits read_proofs(hid_t file, const std::string& name) {
  ProofsOfOrbits proofs;
  if (!hdf5::has(file, "proofs")) return proofs;
  const auto damaged = [&] {
    throw InputError(Place{name, 0, 0, "proofs"}, "the archive is damaged");
  };
  const Handle group = open_group(file, "proofs", name),
               hits = open_group(file, "proof_hits", name);
  proofs.digits = static_cast<int>(hdf5::read_attribute<std::int64_t>(group.get(), "digits", name));
  for (const std::int32_t one : hdf5::read_column<std::int32_t>(group.get(), "proven", name)) {
    proofs.orbits.emplace_back();
    proofs.orbits.back().proven = one != 0;
  }
  for (const auto& [column, field, what] : proof_columns) {
    const std::vector<std::string> texts = hdf5::read_texts(group.get(), column, name);
    if (texts.size() != proofs.orbits.size()) damaged();
    for (std::size_t i = 0; i < texts.size(); ++i) proofs.orbits[i].*field = texts[i];
  }
  const auto orbit = hdf5::read_column<std::int32_t>(hits.get(), "orbit", name);
  const auto x = hdf5::read_texts(hits.get(), "x", name),
             y = hdf5::read_texts(hits.get(), "y", name);
  if (x.size() != orbit.size() || y.size() != orbit.size()) damaged();
  for (std::size_t i = 0; i < orbit.size(); ++i) {
    const auto row = static_cast<std::size_t>(orbit[i]);
    if (orbit[i] < 0 || row >= proofs.orbits.size()) damaged();
    proofs.orbits[row].x.push_back(x[i]);
    proofs.orbits[row].y.push_back(y[i]);
  }
  return proofs;
}

}  // namespace

template <>
struct Fields<OrbitExtra> {
  using E = OrbitExtra;
  static constexpr std::tuple list{
      field("hits", "1", "Number of hits", &E::hits),
      field("maslov", "1", "Maslov index; -1: none", &E::maslov),
      field("multiplier_real", "1", "The larger eigenvalue of the tangent map", &E::real),
      field("multiplier_imaginary", "1", "Its imaginary part, not negative", &E::imaginary)};
};
template <>
struct Fields<HitExtra> {
  static constexpr std::tuple list{
      field("orbit", "1", "Row of /orbits", &HitExtra::orbit),
      field("half_turn", "1", "Half the angle by which the flight turns", &HitExtra::half_turn)};
};

ProofOfOrbit proof_of(const CertifiedPeriodicOrbit& orbit, int digits) {
  ProofOfOrbit proof{orbit.proven, orbit.reason, "", "", "", "", {}, {}};
  if (!orbit.proven) return proof;
  proof.period = orbit.period.text(digits);
  proof.length = orbit.length.text(digits);
  proof.trace = orbit.trace.text(digits);
  if (orbit.multiplier.has_value()) proof.multiplier = orbit.multiplier.text(digits);
  for (const CertifiedNumber& x : orbit.x) proof.x.push_back(x.text(digits));
  for (const CertifiedNumber& y : orbit.y) proof.y.push_back(y.text(digits));
  return proof;
}

void write_orbits(const std::string& name, const LoadedSystem& loaded, const Provenance& origin,
                  const OrbitSearchResult& found, const ProofsOfOrbits& proofs,
                  std::uint64_t most_hits, bool force, ArchiveLock lock) {
  ArchiveFile file = ArchiveFile::begin(orbit_archive_kind, name, loaded, origin, force, lock);
  const std::vector<PeriodicOrbit>& orbits = found.orbits;
  {
    const Handle group = file.group("orbits", "Periodic orbits, by number of hits and length");
    const hid_t to = group.get();
    write_columns(to, std::span(orbits), name);
    write_columns(to, std::span<const OrbitExtra>(extras_of(orbits)), name);
    std::vector<std::string> stabilities;
    for (int k = 0; k <= static_cast<int>(Stability::parabolic); ++k)
      stabilities.push_back(name_of(static_cast<Stability>(k)));
    hdf5::write_attribute(to, "stabilities", stabilities, name);
    hdf5::write_attribute(to, "most_hits", most_hits, name);
    hdf5::write_attribute(to, "zeta", std::int64_t{found.cycles.has_value()}, name);
    each_field<Fields<OrbitSearchResult>>(
        [&](const auto& one) { hdf5::write_attribute(to, one.label.name, one.kept(found), name); });
  }
  {
    const Handle group = file.group("orbit_hits", "Hits of each orbit, one after the other");
    const hid_t to = group.get();
    const FlatHits all = flat(orbits);
    write_columns(to, std::span<const OrbitHit>(all.hits), name);
    write_columns(to, std::span<const HitExtra>(all.extras), name);
    std::vector<std::string> walls;
    for (const Wall& wall : loaded.system.table->walls) walls.push_back(wall.name);
    hdf5::write_attribute(to, "names", walls, name);
  }
  if (!proofs.orbits.empty()) write_proofs(file, proofs);
  file.write_seconds({found.seconds, found.cpu_seconds});
  file.finish(found.complete ? "completed" : "interrupted", found.complete);
}

StoredOrbits read_orbits(const std::string& name) {
  const Handle file = open_kind(name, orbit_archive_kind, "the archive holds no orbits",
                                "an archive written by carom orbit");
  StoredOrbits stored;
  read_head(file.get(), name, stored, stored.result);
  std::vector<PeriodicOrbit>& orbits = stored.result.orbits;
  const Handle group = open_group(file.get(), "orbits", name);
  const hid_t from = group.get();
  orbits = read_all_rows<PeriodicOrbit>(from, name);
  const auto extras = read_all_rows<OrbitExtra>(from, name);
  const Handle hit_group = open_group(file.get(), "orbit_hits", name);
  const auto hits = read_all_rows<OrbitHit>(hit_group.get(), name);
  const auto hit_extras = read_all_rows<HitExtra>(hit_group.get(), name);
  std::size_t row = 0;
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    PeriodicOrbit& o = orbits[i];
    const OrbitExtra& extra = extras.at(i);
    if (extra.maslov != no_index) o.maslov = extra.maslov;
    const std::complex<double> large(extra.real, extra.imaginary);
    o.multipliers[0] = large;
    o.multipliers[1] = large.imag() != 0.0 ? std::conj(large) : 1.0 / large.real();
    for (std::int32_t n = 0; n < extra.hits; ++n, ++row) {
      o.hits.push_back(hits.at(row));
      o.half_turns.push_back(hit_extras.at(row).half_turn);
      const geometry::Cell step = o.hits.back().step;
      o.shift = {o.shift.first + step.first, o.shift.second + step.second};
    }
  }
  each_field<Fields<OrbitSearchResult>>([&](const auto& one) {
    one.set(stored.result, static_cast<std::uint64_t>(
                               hdf5::read_attribute<std::int64_t>(from, one.label.name, name)));
  });
  stored.most_hits =
      static_cast<std::uint64_t>(hdf5::read_attribute<std::int64_t>(from, "most_hits", name));
  // The expansion is made of the orbits again: the same bits.
  if (hdf5::read_attribute<std::int64_t>(from, "zeta", name) != 0)
    stored.result.cycles = expand_cycles(orbits, stored.most_hits);
  stored.proofs = read_proofs(file.get(), name);
  return stored;
}

}  // namespace carom
