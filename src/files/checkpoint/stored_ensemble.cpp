// Ensembles read back from their archives and checkpoints.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/base/whole_number.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/starts/injection.hpp"
#include "carom_version.hpp"
#include "engines/arithmetic.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/ensemble_files.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/hdf5/checksums.hpp"
#include "files/toml/value.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

Handle files::open_ensemble(const std::string& name) {
  return open_archive(name, "the file is not an archive", "an archive written by carom");
}

namespace {

std::string kind_in(const Handle& file, const std::string& name) {
  return hdf5::read_string_attribute(file.get(), "kind", name);
}

template <class Result>
Stored<Result> read_one(const std::string& name) {
  hdf5::silence();
  const Handle file = open_ensemble(name);
  Stored<Result> stored;
  Result& result = stored.result;
  stored.kind = kind_of(result);
  if (kind_in(file, name) != stored.kind)
    throw InputError(Place{name, 0, 0, ""},
                     fmt::format("the archive does not hold {} {} ensemble",
                                 stored.kind == "escape" ? "an" : "a", stored.kind),
                     fmt::format("one written by carom {}", stored.kind));
  hdf5::verify(file.get(), name);
  const Handle provenance = open_group(file.get(), "provenance", name);
  const hid_t from = provenance.get();
  const auto attribute = [&](const char* what) {
    return hdf5::read_string_attribute(from, what, name);
  };
  stored.file = name;
  read_head(file.get(), name, stored, result);
  stored.everywhere = hdf5::read_attribute<std::int64_t>(from, "everywhere", name) == 1;
  if (H5Aexists(from, arithmetic_key) > 0) stored.arithmetic = attribute(arithmetic_key);
  stored.shard = shard_of(attribute("shard"), Place{name, 0, 0, ""});
  stored.origins = ArchiveFile::read_origins(from, name);
  stored.version = stored.origins.back().version;
  stored.merged = hdf5::read_string_list_attribute(from, "merged", name);
  stored.per_trajectory = hdf5::has(file.get(), "trajectories") || hdf5::has(file.get(), "records");
  read_counts(file.get(), name, result);
  read_done(file.get(), name, result);
  const auto count = [&](const char* what) {
    return static_cast<std::uint64_t>(hdf5::read_attribute<std::int64_t>(from, what, name));
  };
  result.decisions = {count("decisions_filter"), count("decisions_exact")};
  const std::string isa = attribute("isa");
  for (const InstructionSet set :
       {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
    if (isa == name_of(set)) result.lanes = set;
  return stored;
}

// Numbers are equal where they mean the same: 10, 1e1 and "20/2". Ensembles know irrational ones as
// doubles alone.
bool same_number(const files::Value& a, const files::Value& b) {
  try {
    const ExactNumber first(a.text, a.place), second(b.text, b.place);
    const auto x = first.to_rational(), y = second.to_rational();
    if (x && y) return x->numerator == y->numerator && x->denominator == y->denominator;
    return !x && !y && first.to_double() == second.to_double();
  } catch (const InputError&) {
    return false;  // a text
  }
}

bool is_name(const std::string& key) {
  return key == "name" || key == "wall" || key == "hole" || key == "file";
}

bool same(const files::Value& a, const files::Value& b, const std::string& key) {
  using Kind = files::Value::Kind;
  const auto may_be_number = [&](const files::Value& value) {
    return value.kind == Kind::number || (value.kind == Kind::text && !is_name(key));
  };
  if (may_be_number(a) && may_be_number(b))
    return (a.kind == b.kind && a.text == b.text) || same_number(a, b);
  if (a.kind != b.kind || a.text != b.text || a.flag != b.flag ||
      a.items.size() != b.items.size() || a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (!same(a.items[i], b.items[i], key)) return false;
  for (const files::Entry& entry : a.entries) {
    const files::Value* other = b.find(entry.key);
    if (other == nullptr || !same(entry.value, *other, entry.key)) return false;
  }
  return true;
}

std::string shown(const files::Value* value) {
  if (value == nullptr) return "missing";
  switch (value->kind) {
    case files::Value::Kind::number:
      return value->text;
    case files::Value::Kind::text:
      return "'" + value->text + "'";
    case files::Value::Kind::boolean:
      return value->flag ? "true" : "false";
    default:
      return "";
  }
}

// What is for readers: titles, which name changes that the other keys hold, and whose step it is.
bool changes_nothing(const std::string& key) {
  return key == "title" || key == "integrator.step_chosen";
}

std::string difference(const std::string& path, const files::Value& a, const files::Value& b,
                       const std::vector<std::string>& but) {
  const auto inner = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  const auto may_differ = [&](const std::string& key) {
    return std::find(but.begin(), but.end(), inner(key)) != but.end();
  };
  const auto say = [](const std::string& key, const files::Value* x, const files::Value* y) {
    const std::string here = shown(x), there = shown(y);
    return here.empty() || there.empty() ? key + " differs"
                                         : fmt::format("{} is {}, not {}", key, there, here);
  };
  for (const files::Entry& entry : a.entries) {
    const files::Value* other = b.find(entry.key);
    if (may_differ(entry.key) || changes_nothing(inner(entry.key)) ||
        (other != nullptr && same(entry.value, *other, entry.key)))
      continue;
    const bool tables = other != nullptr && entry.value.kind == files::Value::Kind::table &&
                        other->kind == entry.value.kind;
    if (!tables) return say(inner(entry.key), &entry.value, other);
    const std::string within = difference(inner(entry.key), entry.value, *other, but);
    if (!within.empty()) return within;
  }
  for (const files::Entry& entry : b.entries)
    if (!may_differ(entry.key) && !changes_nothing(inner(entry.key)) &&
        a.find(entry.key) == nullptr)
      return say(inner(entry.key), nullptr, &entry.value);
  return {};
}

}  // namespace

std::string difference(const std::string& toml, const std::string& other_toml,
                       const std::vector<std::string>& but) {
  const files::Value a = files::parse_document(toml, "system"),
                     b = files::parse_document(other_toml, "system");
  return difference("", a, b, but);
}

bool files::are_one_ensemble(const StoredEnsemble& a, const StoredEnsemble& b) {
  return a.kind == b.kind && difference(a.system_toml, b.system_toml).empty() &&
         a.shard == b.shard && a.version == b.version && a.engine == b.engine &&
         a.everywhere == b.everywhere && a.arithmetic == b.arithmetic &&
         a.per_trajectory == b.per_trajectory;
}

LoadedSystem system_of(const StoredEnsemble& stored) {
  LoadedSystem loaded = read_system(stored.system_toml, stored.file + ": /system");
  loaded.system.name = stored.system_name;
  loaded.system.dynamics.everywhere = stored.everywhere;
  return loaded;
}

template <class Result>
Stored<Result> read_ensemble(const std::string& file) {
  const std::string name = archive_named(file), checkpoint = checkpoint_of(name);
  if (!has_checkpoint(name)) return read_one<Result>(name);
  Stored<Result> part = read_one<Result>(checkpoint);
  if (!exists(name)) return part;
  Stored<Result> whole;
  try {
    whole = read_one<Result>(name);
  } catch (const InputError&) {
    return part;  // what is to be replaced may be anything
  }
  return are_one_ensemble(whole, part) && whole.result.done.size() >= part.result.done.size()
             ? whole
             : part;
}

#define CAROM_MAKE(Result) template Stored<Result> read_ensemble(const std::string&);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

bool is_complete(const std::string& file) {
  hdf5::silence();
  try {
    return hdf5::read_attribute<std::int64_t>(open_ensemble(file).get(), "complete", file) == 1;
  } catch (const InputError&) {
    return false;
  }
}

std::string kind_of_ensemble(const std::string& file) {
  hdf5::silence();
  std::string name = archive_named(file);
  if (has_checkpoint(name))
    name = checkpoint_of(name);
  else if (const std::vector<std::string> parts = parts_of_ranks(name); !parts.empty())
    return kind_of_ensemble(parts.front());
  const std::string kind = kind_in(open_ensemble(name), name);
  if (!is_ensemble(kind))
    throw InputError(
        Place{name, 0, 0, ""}, "the archive does not hold an ensemble",
        fmt::format("one written by carom {}", fmt::join(kinds_of_ensembles(), ", carom ")));
  return kind;
}

Shard shard_of(const std::string& text, const Place& place) {
  constexpr std::uint64_t most = (std::uint64_t{1} << 32) - 1;
  const auto fail = [&](const std::string& problem, const char* expected) {
    return InputError(place, problem, expected);
  };
  const std::size_t slash = text.find('/');
  const auto part = [&](const std::string& number) {
    try {
      return whole_number(ExactNumber(number, place), 1);
    } catch (const InputError&) {
      return std::optional<std::uint64_t>();
    }
  };
  const auto k = slash == std::string::npos ? std::nullopt : part(text.substr(0, slash));
  const auto of = slash == std::string::npos ? std::nullopt : part(text.substr(slash + 1));
  if (!k || !of)
    throw fail(fmt::format("'{}' is not a part", text), "K/N: part K of N, such as 2/8");
  if (*of > most) throw fail("there are too many parts", "less than 2^32");
  if (*k > *of) throw fail(fmt::format("there is no part {} of {}", *k, *of), "K from 1 to N");
  return {*k, *of};
}

void refuse_other_version(const StoredEnsemble& stored) {
  if (stored.version != version)
    throw InputError(Place{stored.file, 0, 0, "version"},
                     fmt::format("version {} wrote it", stored.version),
                     fmt::format("version {}, which this is", version));
  if (stored.arithmetic != engines::arithmetic_fingerprint())
    throw InputError(
        Place{stored.file, 0, 0, arithmetic_key},
        "another arithmetic wrote it: the digits of its orbits, or of its digest, are others",
        "the build of carom that wrote it, or a run anew");
}

void files::write_pieces(const ArchiveFile& file, const std::vector<RecordLog::Piece>& pieces) {
  const Handle group = file.group(
      "records",
      "Where the records of the trajectories first … last - 1 stand in the file of records");
  const auto column = [&](const char* name, std::uint64_t RecordLog::Piece::*field,
                          const char* text) {
    std::vector<std::uint64_t> values;
    for (const RecordLog::Piece& piece : pieces) values.push_back(piece.*field);
    hdf5::write_column(group.get(), name, std::span(std::as_const(values)), {"1", text},
                       file.name());
  };
  column("first", &RecordLog::Piece::first, "First trajectory");
  column("last", &RecordLog::Piece::last, "One after the last");
  column("row", &RecordLog::Piece::row, "First record");
  column("rows", &RecordLog::Piece::rows, "Number of records");
  column("sum", &RecordLog::Piece::sum, "Hash of their bytes");
}

std::vector<RecordLog::Piece> files::read_pieces(const std::string& checkpoint,
                                                 const TrajectoryRanges& done) {
  const Handle file = open_ensemble(checkpoint);
  const Handle group = open_group(file.get(), "records", checkpoint);
  std::vector<RecordLog::Piece> pieces;
  const auto column = [&](const char* name, std::uint64_t RecordLog::Piece::*field) {
    const auto values = hdf5::read_column<std::uint64_t>(group.get(), name, checkpoint);
    if (pieces.empty()) pieces.resize(values.size());
    if (pieces.size() != values.size())
      damaged(checkpoint, fmt::format("'/records/{}' differs in length", name));
    for (std::size_t i = 0; i < values.size(); ++i) pieces[i].*field = values[i];
  };
  column("first", &RecordLog::Piece::first);
  column("last", &RecordLog::Piece::last);
  column("row", &RecordLog::Piece::row);
  column("rows", &RecordLog::Piece::rows);
  column("sum", &RecordLog::Piece::sum);
  TrajectoryRanges held;
  bool once = true;
  for (const RecordLog::Piece& piece : pieces)
    once = held.add(TrajectoryRange{piece.first, piece.last}) && once;
  if (!once || held != done)
    damaged(checkpoint, "'/records' holds others than the trajectories of '/done'");
  return pieces;
}

void files::copy_records(const StoredEnsemble& stored, const TrajectoryRanges& done,
                         const System& system, RecordLog& log) {
  RecordReader reader(stored.file);
  std::vector<TrajectoryRecord> batch;
  bool more = reader.next(batch);
  auto next = batch.begin();
  // Pieces of a moderate size, so that one of them fits the memory.
  constexpr std::uint64_t most = 1 << 16;
  for (const TrajectoryRange& range : done.ranges())
    for (std::uint64_t first = range.first; first < range.last;
         first += std::min(most, range.last - first)) {
      const TrajectoryRange piece{first, first + std::min(most, range.last - first)};
      std::vector<TrajectoryRecord> records;
      while (more) {
        if (next == batch.end()) {
          more = reader.next(batch);
          next = batch.begin();
          continue;
        }
        if (next->index >= particle_index(system, piece.last, 0)) break;
        records.push_back(*next++);
      }
      log.add(piece, std::move(records));
    }
  log.mark();
}

}  // namespace carom
