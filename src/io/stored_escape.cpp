// Escape ensembles read back from their archives and checkpoints.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom_version.hpp"
#include "io/escape_columns.hpp"
#include "io/escape_files.hpp"
#include "io/value.hpp"

namespace carom {

using hdf5::Handle;

namespace {

Handle open_archive(const std::string& name) {
  const Place place{name, 0, 0, ""};
  if (!exists(name)) throw InputError(place, "there is no such file");
  Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) throw InputError(place, "the file is not an archive", "an archive written by carom escape");
  if (hdf5::read_string_attribute(file.get(), "kind", name) != "escape")
    throw InputError(place, "the archive does not hold an escape ensemble", "one written by carom escape");
  if (hdf5::read_integer_attribute(file.get(), "schema", name) != archive_schema)
    throw InputError(place, "the archive has another schema", "one written by this version of carom");
  return file;
}

Shard shard_of(const std::string& text, const std::string& name) {
  Shard shard;
  char* end = nullptr;
  shard.k = std::strtoull(text.c_str(), &end, 10);
  if (*end == '/') shard.of = std::strtoull(end + 1, &end, 10);
  if (*end != '\0' || shard.k < 1 || shard.k > shard.of)
    throw InputError(Place{name, 0, 0, ""}, fmt::format("'{}' is not a part of an ensemble", text));
  return shard;
}

StoredEscape read_one(const std::string& name) {
  hdf5::silence();
  const Handle file = open_archive(name);
  const Handle provenance(H5Gopen2(file.get(), "provenance", H5P_DEFAULT), H5Gclose);
  const hid_t from = provenance.get();
  const auto attribute = [&](const char* what) { return hdf5::read_string_attribute(from, what, name); };
  StoredEscape stored;
  stored.file = name;
  stored.status = hdf5::read_string_attribute(file.get(), "status", name);
  stored.system_toml = hdf5::read_text(file.get(), "system", name);
  stored.system_name = attribute("system");
  stored.engine = attribute("engine");
  stored.everywhere = hdf5::read_integer_attribute(from, "everywhere", name) == 1;
  stored.shard = shard_of(attribute("shard"), name);
  stored.origins = ArchiveFile::read_origins(from, name);
  stored.version = stored.origins.back().version;
  stored.per_trajectory = H5Lexists(file.get(), "trajectories", H5P_DEFAULT) > 0 ||
                          H5Lexists(file.get(), "records", H5P_DEFAULT) > 0;
  EscapeResult& result = stored.result;
  result = read_counts(file.get(), name);
  result.complete = hdf5::read_integer_attribute(file.get(), "complete", name) == 1;
  result.threads = static_cast<int>(hdf5::read_integer_attribute(from, "threads", name));
  result.seconds = hdf5::read_real_attribute(from, "seconds", name);
  result.cpu_seconds = hdf5::read_real_attribute(from, "cpu_seconds", name);
  const auto count = [&](const char* what) {
    return static_cast<std::uint64_t>(hdf5::read_integer_attribute(from, what, name));
  };
  result.decisions = {count("decisions_filter"), count("decisions_exact")};
  result.effort = {count("lanes_hits"), count("lanes_left"), count("lanes_steps"), count("lanes_idle")};
  const std::string isa = attribute("isa");
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
    if (isa == name_of(set)) result.lanes = set;
  return stored;
}

bool same(const io::Value& a, const io::Value& b) {
  if (a.kind != b.kind || a.flag != b.flag || a.items.size() != b.items.size() || a.entries.size() != b.entries.size())
    return false;
  if (a.text != b.text) {
    if (a.kind != io::Value::Kind::number) return false;
    const auto x = ExactNumber(a.text, a.place).to_rational(), y = ExactNumber(b.text, b.place).to_rational();
    if (!x || !y || x->numerator != y->numerator || x->denominator != y->denominator) return false;
  }
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (!same(a.items[i], b.items[i])) return false;
  for (const io::Entry& entry : a.entries) {
    const io::Value* other = b.find(entry.key);
    if (other == nullptr || !same(entry.value, *other)) return false;
  }
  return true;
}

std::string shown(const io::Value* value) {
  if (value == nullptr) return "missing";
  switch (value->kind) {
    case io::Value::Kind::number: return value->text;
    case io::Value::Kind::text: return "'" + value->text + "'";
    case io::Value::Kind::boolean: return value->flag ? "true" : "false";
    default: return "";
  }
}

std::string difference(const std::string& path, const io::Value& a, const io::Value& b) {
  const auto inner = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  const auto say = [](const std::string& key, const io::Value* x, const io::Value* y) {
    const std::string here = shown(x), there = shown(y);
    return here.empty() || there.empty() ? key + " differs" : fmt::format("{} is {}, not {}", key, there, here);
  };
  for (const io::Entry& entry : a.entries) {
    const io::Value* other = b.find(entry.key);
    if (other != nullptr && same(entry.value, *other)) continue;
    const bool tables = other != nullptr && entry.value.kind == io::Value::Kind::table && other->kind == entry.value.kind;
    return tables ? difference(inner(entry.key), entry.value, *other) : say(inner(entry.key), &entry.value, other);
  }
  for (const io::Entry& entry : b.entries)
    if (a.find(entry.key) == nullptr) return say(inner(entry.key), nullptr, &entry.value);
  return {};
}

}  // namespace

std::string difference(const std::string& toml, const std::string& other_toml) {
  io::Value a = io::parse_document(toml, "system"), b = io::parse_document(other_toml, "system");
  return difference("", a, b);
}

bool exists(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

bool has_checkpoint(const std::string& file) {
  const std::string checkpoint = checkpoint_of(file);  // or what another command was writing there
  if (!exists(checkpoint)) return false;
  try {
    hdf5::silence();
    return hdf5::read_string_attribute(open_archive(checkpoint).get(), "kind", checkpoint) == "escape";
  } catch (const InputError&) {
    return false;
  }
}

void remove_checkpoint(const std::string& file) {
  if (!has_checkpoint(file)) return;
  std::remove(checkpoint_of(file).c_str());
  std::remove(records_of(file).c_str());
}

StoredEscape read_escape(const std::string& file) {
  const std::string checkpoint = checkpoint_of(file);
  if (!exists(checkpoint)) return read_one(file);
  StoredEscape part = read_one(checkpoint);
  if (!exists(file)) return part;
  StoredEscape whole = read_one(file);
  const bool one_ensemble = difference(whole.system_toml, part.system_toml).empty() && whole.shard == part.shard &&
                            whole.version == part.version &&
                            whole.engine == part.engine && whole.everywhere == part.everywhere && whole.per_trajectory == part.per_trajectory;
  return one_ensemble && whole.result.done.size() >= part.result.done.size() ? whole : part;
}

void refuse_other_version(const StoredEscape& stored) {
  if (stored.version == version) return;
  throw InputError(Place{stored.file, 0, 0, "version"}, fmt::format("version {} wrote it", stored.version),
                   fmt::format("version {}, which this is", version));
}

void write_pieces(const ArchiveFile& file, const std::vector<RecordLog::Piece>& pieces) {
  const Handle group = file.group("records", "Where the records of the trajectories first … last - 1 stand in FILE.records");
  const auto column = [&](const char* name, std::uint64_t RecordLog::Piece::*field, const char* text) {
    std::vector<std::uint64_t> values;
    for (const RecordLog::Piece& piece : pieces) values.push_back(piece.*field);
    hdf5::write_column(group.get(), name, std::span(std::as_const(values)), {"1", text}, file.name());
  };
  column("first", &RecordLog::Piece::first, "First trajectory");
  column("last", &RecordLog::Piece::last, "One after the last");
  column("row", &RecordLog::Piece::row, "First record");
  column("rows", &RecordLog::Piece::rows, "Number of records");
}

std::vector<RecordLog::Piece> read_pieces(const std::string& checkpoint) {
  const Handle file = open_archive(checkpoint);
  const Handle group(H5Gopen2(file.get(), "records", H5P_DEFAULT), H5Gclose);
  std::vector<RecordLog::Piece> pieces;
  const auto column = [&](const char* name, std::uint64_t RecordLog::Piece::*field) {
    const auto values = hdf5::read_column<std::uint64_t>(group.get(), name, checkpoint);
    pieces.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) pieces[i].*field = values[i];
  };
  column("first", &RecordLog::Piece::first);
  column("last", &RecordLog::Piece::last);
  column("row", &RecordLog::Piece::row);
  column("rows", &RecordLog::Piece::rows);
  return pieces;
}

void copy_records(const StoredEscape& stored, const System& system, RecordLog& log) {
  RecordReader reader(stored.file);
  std::vector<TrajectoryRecord> batch;
  bool more = reader.next(batch);
  auto next = batch.begin();
  // Pieces of a moderate size, so that one of them fits the memory.
  constexpr std::uint64_t most = 1 << 16;
  for (const TrajectoryRange& range : stored.result.done.ranges())
    for (std::uint64_t first = range.first; first < range.last; first += std::min(most, range.last - first)) {
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
