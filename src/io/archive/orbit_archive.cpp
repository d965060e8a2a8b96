#include "carom/io/orbit_archive.hpp"

#include <span>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/archive/ensemble_columns.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;
using hdf5::Handle;

namespace {

constexpr const char* orbit_archive_kind = "orbit";
constexpr std::int32_t no_index = -1;

// Columns of /orbits and /orbit_hits, where writing and reading meet: `table.column` is called for
// each with its name, what it is, and the place of its value in a row.
template <class Table>
void orbit_columns(Table& table) {
  using Orbit = PeriodicOrbit;
  table.real("period", {"time", "Period"}, [](Orbit& o) -> double& { return o.period; });
  table.real("length", {"length", "Length"}, [](Orbit& o) -> double& { return o.length; });
  table.real("action", {"mass*length^2/time", "Closed integral of p dq"},
             [](Orbit& o) -> double& { return o.action; });
  table.real("trace", {"1", "Trace of the tangent map"},
             [](Orbit& o) -> double& { return o.trace; });
  table.real("position_error", {"length", "Bound of the error of the hits' places"},
             [](Orbit& o) -> double& { return o.position_error; });
  table.real("length_error", {"length", "Bound of the error of the length"},
             [](Orbit& o) -> double& { return o.length_error; });
  table.real("trace_error", {"1", "Estimated error of the trace"},
             [](Orbit& o) -> double& { return o.trace_error; });
  table.real("reduced_period", {"time", "Period of the part that symmetry leaves"},
             [](Orbit& o) -> double& { return o.reduced.period; });
  table.real("reduced_trace", {"1", "Trace of its tangent map, turned back"},
             [](Orbit& o) -> double& { return o.reduced.trace; });
  table.real("reduced_multiplier", {"1", "Its real eigenvalue of largest size; NaN: none"},
             [](Orbit& o) -> double& { return o.reduced.multiplier; });
  table.whole("reduced_order", {"1", "Number of such parts"},
              [](Orbit& o) -> int& { return o.reduced.order; });
  table.whole("copies", {"1", "Orbits that symmetries and reversal make of it"},
              [](Orbit& o) -> int& { return o.copies; });
}
template <class Table>
void hit_columns(Table& table) {
  using Hit = OrbitHit;
  table.whole("wall", {"1", "Index into the attribute `names` of the group"},
              [](Hit& h) -> int& { return h.wall; });
  table.whole("hole", {"1", "Index of the hole in which it lies; -1: none"},
              [](Hit& h) -> int& { return h.hole; });
  table.real("u", {"1", "Parameter on the wall"}, [](Hit& h) -> double& { return h.u; });
  table.real("s", {"length", "Length along the wall"}, [](Hit& h) -> double& { return h.s; });
  table.real("v_parallel", {"length/time", "Velocity in the direction of s"},
             [](Hit& h) -> double& { return h.v_parallel; });
  table.real("x", {"length", "Position, in the home cell"},
             [](Hit& h) -> double& { return h.position.x; });
  table.real("y", {"length", "Position, in the home cell"},
             [](Hit& h) -> double& { return h.position.y; });
  table.real("vx", {"length/time", "Velocity after the hit"},
             [](Hit& h) -> double& { return h.velocity.x; });
  table.real("vy", {"length/time", "Velocity after the hit"},
             [](Hit& h) -> double& { return h.velocity.y; });
  table.real("flight_time", {"time", "Until the next hit"},
             [](Hit& h) -> double& { return h.flight_time; });
}

template <class Row>
struct Writer {
  hid_t group;
  const std::vector<Row*>& rows;
  const std::string& file;

  template <class Value>
  void real(const char* name, hdf5::Description what, Value value) const {
    write<double>(name, what, value);
  }
  template <class Value>
  void whole(const char* name, hdf5::Description what, Value value) const {
    write<std::int32_t>(name, what, value);
  }
  template <class T, class Value>
  void write(const char* name, hdf5::Description what, Value value) const {
    std::vector<T> column;
    for (Row* row : rows) column.push_back(static_cast<T>(value(*row)));
    hdf5::write_column<T>(group, name, column, what, file);
  }
};

template <class Row>
struct Reader {
  hid_t group;
  const std::vector<Row*>& rows;
  const std::string& file;

  template <class Value>
  void real(const char* name, hdf5::Description, Value value) const {
    read<double>(name, value);
  }
  template <class Value>
  void whole(const char* name, hdf5::Description, Value value) const {
    read<std::int32_t>(name, value);
  }
  template <class T, class Value>
  void read(const char* name, Value value) const {
    const std::vector<T> column = hdf5::read_column<T>(group, name, file);
    if (column.size() != rows.size())
      throw InputError(Place{file, 0, 0, name}, "the archive is damaged");
    for (std::size_t i = 0; i < rows.size(); ++i) value(*rows[i]) = column[i];
  }
};

// What has no place of its own in an orbit's or hit's row.
struct Extra {
  std::vector<std::int32_t> hits, stability, maslov, family, orbit;
  std::vector<double> real, imaginary, half_turn;
  std::vector<std::int64_t> step_first, step_second;
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

struct Count {
  const char* name;
  std::uint64_t OrbitSearchResult::*value;
  const char* text;
};
constexpr Count counts[] = {
    {"words", &OrbitSearchResult::words, "Cyclic words of discs that were tried"},
    {"recurrences", &OrbitSearchResult::recurrences, "Recurrences that were tried"},
    {"unsolved", &OrbitSearchResult::unsolved, "Starts that led to no orbit"},
    {"shadowed", &OrbitSearchResult::shadowed, "Starts that led to one with a wall in its way"},
    {"symmetries", &OrbitSearchResult::symmetries, "Isometries of the table"},
};

std::vector<PeriodicOrbit*> pointers(std::vector<PeriodicOrbit>& orbits) {
  std::vector<PeriodicOrbit*> all;
  for (PeriodicOrbit& orbit : orbits) all.push_back(&orbit);
  return all;
}
std::vector<OrbitHit*> hit_pointers(std::vector<PeriodicOrbit>& orbits) {
  std::vector<OrbitHit*> all;
  for (PeriodicOrbit& orbit : orbits)
    for (OrbitHit& hit : orbit.hits) all.push_back(&hit);
  return all;
}

Extra extra_of(const std::vector<PeriodicOrbit>& orbits) {
  Extra extra;
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    const PeriodicOrbit& o = orbits[i];
    extra.hits.push_back(static_cast<std::int32_t>(o.hits.size()));
    extra.stability.push_back(static_cast<std::int32_t>(o.stability));
    extra.maslov.push_back(o.maslov.value_or(no_index));
    extra.family.push_back(o.family);
    extra.real.push_back(o.multipliers[0].real());
    extra.imaginary.push_back(o.multipliers[0].imag());
    for (std::size_t h = 0; h < o.hits.size(); ++h) {
      extra.orbit.push_back(static_cast<std::int32_t>(i));
      extra.half_turn.push_back(o.half_turns[h]);
      extra.step_first.push_back(o.hits[h].step.first);
      extra.step_second.push_back(o.hits[h].step.second);
    }
  }
  return extra;
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
  const Handle hits = file.group("proof_hits", "Proven places of hits, orbit after orbit");
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
  proofs.digits = static_cast<int>(hdf5::read_integer_attribute(group.get(), "digits", name));
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

const char* const names_of_stability[] = {"elliptic", "hyperbolic", "inverse hyperbolic",
                                          "parabolic"};

}  // namespace

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
  if (!lock) lock = lock_archive(name);
  refuse_existing(name, force);
  hdf5::silence();
  ArchiveFile file = ArchiveFile::create(aside_of(name), name);
  file.write_head(orbit_archive_kind, loaded, origin);
  std::vector<PeriodicOrbit> orbits = found.orbits;
  const Extra extra = extra_of(orbits);
  {
    const Handle group = file.group("orbits", "Periodic orbits, by number of hits and length");
    const hid_t to = group.get();
    const std::vector<PeriodicOrbit*> rows = pointers(orbits);
    hdf5::write_column<std::int32_t>(to, "hits", extra.hits, {"1", "Number of hits"}, name);
    Writer<PeriodicOrbit> writer{to, rows, name};
    orbit_columns(writer);
    hdf5::write_column<std::int32_t>(to, "stability", extra.stability,
                                     {"1", "Index into the attribute `stabilities` of the group"},
                                     name);
    hdf5::write_column<std::int32_t>(to, "maslov", extra.maslov, {"1", "Maslov index; -1: none"},
                                     name);
    hdf5::write_column<std::int32_t>(to, "family", extra.family, {"1", "1: one member of a family"},
                                     name);
    hdf5::write_column<double>(to, "multiplier_real", extra.real,
                               {"1", "The larger eigenvalue of the tangent map"}, name);
    hdf5::write_column<double>(to, "multiplier_imaginary", extra.imaginary,
                               {"1", "Its imaginary part, not negative"}, name);
    hdf5::write_attribute(
        to, "stabilities",
        std::vector<std::string>(std::begin(names_of_stability), std::end(names_of_stability)),
        name);
    hdf5::write_attribute(to, "most_hits", most_hits, name);
    hdf5::write_attribute(to, "zeta", std::int64_t{found.cycles.has_value()}, name);
    for (const Count& count : counts)
      hdf5::write_attribute(to, count.name, found.*count.value, name);
  }
  {
    const Handle group = file.group("orbit_hits", "Hits of each orbit, one after the other");
    const hid_t to = group.get();
    const std::vector<OrbitHit*> rows = hit_pointers(orbits);
    hdf5::write_column<std::int32_t>(to, "orbit", extra.orbit, {"1", "Row of /orbits"}, name);
    Writer<OrbitHit> writer{to, rows, name};
    hit_columns(writer);
    hdf5::write_column<double>(to, "half_turn", extra.half_turn,
                               {"1", "Half the angle that the flight turns by"}, name);
    hdf5::write_column<std::int64_t>(to, "step_first", extra.step_first,
                                     {"1", "Cells to the next hit, along the first vector"}, name);
    hdf5::write_column<std::int64_t>(to, "step_second", extra.step_second,
                                     {"1", "Cells to the next hit, along the second vector"}, name);
    std::vector<std::string> walls;
    for (const Wall& wall : loaded.system.table->walls) walls.push_back(wall.name);
    hdf5::write_attribute(to, "names", walls, name);
  }
  if (!proofs.orbits.empty()) write_proofs(file, proofs);
  file.write_seconds({found.seconds, found.cpu_seconds});
  file.set_status(found.complete ? "completed" : "interrupted", found.complete);
  file.keep_as(name);
  give_up_checkpoint(name);
}

StoredOrbits read_orbits(const std::string& name) {
  hdf5::silence();
  const Handle file = open_archive(name, "the file is not an archive, or it is still being written",
                                   "an archive of carom");
  if (hdf5::read_string_attribute(file.get(), "kind", name) != orbit_archive_kind)
    throw InputError(Place{name, 0, 0, ""}, "the archive holds no orbits",
                     "an archive written by carom orbit");
  hdf5::verify(file.get(), name);
  const auto opened = [&](const char* group) {
    return hdf5::checked(H5Gopen2(file.get(), group, H5P_DEFAULT), H5Gclose, name);
  };
  StoredOrbits stored;
  std::vector<PeriodicOrbit>& orbits = stored.result.orbits;
  const Handle group = opened("orbits");
  const hid_t from = group.get();
  const auto hits = hdf5::read_column<std::int32_t>(from, "hits", name);
  for (const std::int32_t n : hits) {
    orbits.emplace_back();
    orbits.back().hits.resize(static_cast<std::size_t>(n));
  }
  const std::vector<PeriodicOrbit*> rows = pointers(orbits);
  Reader<PeriodicOrbit> reader{from, rows, name};
  orbit_columns(reader);
  const auto stability = hdf5::read_column<std::int32_t>(from, "stability", name);
  const auto maslov = hdf5::read_column<std::int32_t>(from, "maslov", name);
  const auto family = hdf5::read_column<std::int32_t>(from, "family", name);
  const auto real = hdf5::read_column<double>(from, "multiplier_real", name);
  const auto imaginary = hdf5::read_column<double>(from, "multiplier_imaginary", name);
  const Handle hit_group = opened("orbit_hits");
  const std::vector<OrbitHit*> hit_rows = hit_pointers(orbits);
  Reader<OrbitHit> hit_reader{hit_group.get(), hit_rows, name};
  hit_columns(hit_reader);
  const auto half = hdf5::read_column<double>(hit_group.get(), "half_turn", name);
  const auto first = hdf5::read_column<std::int64_t>(hit_group.get(), "step_first", name);
  const auto second = hdf5::read_column<std::int64_t>(hit_group.get(), "step_second", name);
  std::size_t row = 0;
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    PeriodicOrbit& o = orbits[i];
    o.stability = static_cast<Stability>(stability.at(i));
    if (maslov.at(i) != no_index) o.maslov = maslov.at(i);
    o.family = family.at(i) != 0;
    const std::complex<double> large(real.at(i), imaginary.at(i));
    o.multipliers[0] = large;
    o.multipliers[1] = large.imag() != 0.0 ? std::conj(large) : 1.0 / large;
    for (OrbitHit& hit : o.hits) {
      hit.step = {first.at(row), second.at(row)};
      o.shift = {o.shift.first + hit.step.first, o.shift.second + hit.step.second};
      o.half_turns.push_back(half.at(row++));
    }
  }
  for (const Count& count : counts)
    stored.result.*count.value =
        static_cast<std::uint64_t>(hdf5::read_integer_attribute(from, count.name, name));
  stored.most_hits =
      static_cast<std::uint64_t>(hdf5::read_integer_attribute(from, "most_hits", name));
  // The expansion is made of the orbits again: the same bits.
  if (hdf5::read_integer_attribute(from, "zeta", name) != 0)
    stored.result.cycles = expand_cycles(orbits, stored.most_hits);
  stored.proofs = read_proofs(file.get(), name);
  stored.result.complete = hdf5::read_integer_attribute(file.get(), "complete", name) != 0;
  stored.status = stored.result.complete ? "completed" : "interrupted";
  stored.system_toml = hdf5::read_text(file.get(), "system", name);
  const Handle provenance = opened("provenance");
  stored.system_name = hdf5::read_string_attribute(provenance.get(), "system", name);
  const Seconds seconds = ArchiveFile::read_seconds(provenance.get(), name);
  stored.result.seconds = seconds.wall;
  stored.result.cpu_seconds = seconds.cpu;
  stored.result.threads =
      static_cast<int>(hdf5::read_integer_attribute(provenance.get(), "threads", name));
  return stored;
}

}  // namespace carom
