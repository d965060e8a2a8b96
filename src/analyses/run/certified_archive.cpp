#include "carom/analyses/run/certified_archive.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "carom/base/error.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/columns.hpp"
#include "files/hdf5/fields.hpp"

namespace carom {

using namespace files;
using hdf5::Description;
using hdf5::Handle;

namespace {

struct Coordinate {
  const char *name, *decimals;
  CertifiedNumber CertifiedState::*value;
  Description description;
};
const std::array<Coordinate, 5> coordinates{{
    {"t", "t_decimals", &CertifiedState::t, {"time", "Time"}},
    {"x", "x_decimals", &CertifiedState::x, {"length", "Position, unwrapped"}},
    {"y", "y_decimals", &CertifiedState::y, {"length", "Position, unwrapped"}},
    {"vx", "vx_decimals", &CertifiedState::vx, {"length/time", "Velocity after the event"}},
    {"vy", "vy_decimals", &CertifiedState::vy, {"length/time", "Velocity after the event"}},
}};

// Texts of one length, padded with zeros, row by row in batches of about a megabyte. A longer one
// makes all of them longer.
class TextColumn {
 public:
  TextColumn(hid_t group, const char* name, std::size_t length, Description description,
             const std::string& file)
      : group_(group), name_(name), description_(description), file_(file) {
    begin(name_, length);
  }

  void push(const std::string& text) {
    if (text.size() > length_) widen(text.size() + room_to_grow);
    const std::size_t size = pending_.size();
    pending_ += text;
    pending_.resize(size + length_, '\0');
    if (pending_.size() >= batch_ * length_) flush();
  }
  void close() {
    flush();
    hdf5::check(dataset_.close(), file_);
  }

 private:
  static constexpr std::size_t room_to_grow = 20;

  void begin(const std::string& name, std::size_t length) {
    length_ = length;
    batch_ = std::clamp<std::size_t>((1u << 20) / length, 1, 1024);
    rows_ = 0;
    type_ = hdf5::checked(H5Tcopy(H5T_C_S1), H5Tclose, file_);
    hdf5::check(H5Tset_size(type_.get(), length_) >= 0, file_);
    dataset_ = hdf5::create_growing(group_, name.c_str(), type_.get(), batch_, description_, file_);
  }

  // The rows so far move to a column with room, which takes the place and the name of this one.
  void widen(std::size_t length) {
    flush();
    const Handle narrow = std::move(dataset_);
    const std::size_t rows = rows_;
    const std::string wide = name_ + ".wide";
    begin(wide, length);
    for (std::size_t row = 0; row < rows; row += batch_) {
      const std::size_t count = std::min(batch_, rows - row);
      pending_.assign(count * length_, '\0');
      hdf5::read_rows(narrow.get(), type_.get(), row, count, pending_.data(), file_);
      flush();
    }
    hdf5::check(H5Ldelete(group_, name_.c_str(), H5P_DEFAULT) >= 0, file_);
    hdf5::check(H5Lmove(group_, wide.c_str(), group_, name_.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0,
                file_);
  }

  void flush() {
    const std::size_t count = pending_.size() / length_;
    if (count == 0) return;
    hdf5::append_rows(dataset_.get(), type_.get(), rows_, count, pending_.data(), file_);
    rows_ += count;
    pending_.clear();
  }

  hid_t group_;
  std::string name_;
  Description description_;
  std::string file_;
  std::size_t length_ = 0, batch_ = 0, rows_ = 0;
  Handle type_, dataset_;
  std::string pending_;
};

}  // namespace

class CertifiedArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& loaded, const Provenance& origin,
                 const CertifiedTask& task, bool force, ArchiveLock held)
      : lock(std::move(held)),
        target(path),
        digits(task.digits),
        file(ArchiveFile::begin(certified_archive_kind, path, loaded, origin, force, lock)),
        rows(path) {
    for (const Wall& w : loaded.system.table->walls) walls.push_back(w.name);
    for (const Hole& h : loaded.system.table->holes) holes.push_back(h.name);
    collisions = file.group("collisions", "Reflections in order of time: the states after them");
    const hid_t to = collisions.get();
    rows.add<std::uint64_t>(to, "number", {"1", "Number of the collision, from 1"});
    const hid_t wall =
        rows.add<std::int32_t>(to, "wall", {"1", "Index into the attribute `names`"});
    if (!walls.empty()) hdf5::write_attribute(wall, "names", walls, target);
    rows.add<std::int64_t>(to, "cell_first", {"1", "Cell of the lattice"});
    rows.add<std::int64_t>(to, "cell_second", {"1", "Cell of the lattice"});
    for (const Coordinate& c : coordinates) rows.add<double>(to, c.name, c.description);
    // Twenty digits before the point, a sign and the point: more as they come.
    const std::size_t length = static_cast<std::size_t>(digits) + 22;
    for (const Coordinate& c : coordinates)
      texts.emplace_back(to, c.decimals, length, c.description, target);
  }

  void write_end(const CertifiedEnd& end) {
    const Handle group = file.group(
        "state", "Where the orbit ended: after the last event, at the last time or in a hole");
    const hid_t to = group.get();
    const auto integer = [&](const char* name, std::int64_t value, const char* text) {
      hdf5::write_number(to, name, value, {"1", text}, target);
    };
    integer("hits", static_cast<std::int64_t>(end.collisions), "Reflections");
    integer("last_wall", end.wall, "Wall of the last reflection, -1: none");
    integer("hole", end.hole, "Hole it escaped through, -1: none");
    integer("cell_first", end.cell.first, "Cell of the lattice");
    integer("cell_second", end.cell.second, "Cell of the lattice");
    if (!end.t.has_value()) return;
    for (const Coordinate& c : coordinates) {
      const double value = (end.*c.value).to_double();
      hdf5::write_number(to, c.name, value, c.description, target);
      hdf5::write_text(to, c.decimals, (end.*c.value).text(digits), c.description, target);
    }
  }

  ArchiveLock lock;  // first: it lets go last
  std::string target;
  int digits;
  ArchiveFile file;
  hdf5::Columns rows;
  Handle collisions;  ///< the group, while columns may grow
  std::vector<TextColumn> texts;
  std::vector<std::string> walls, holes;
};

CertifiedArchive::CertifiedArchive(const std::string& file, const LoadedSystem& loaded,
                                   const Provenance& origin, const CertifiedTask& task, bool force,
                                   ArchiveLock lock)
    : implementation_(
          std::make_unique<Implementation>(file, loaded, origin, task, force, std::move(lock))) {}
CertifiedArchive::~CertifiedArchive() = default;

void CertifiedArchive::hit(const CertifiedHit& hit) {
  Implementation& a = *implementation_;
  a.rows.row(hit.number, std::int32_t{hit.wall}, hit.cell.first, hit.cell.second, hit.t.to_double(),
             hit.x.to_double(), hit.y.to_double(), hit.vx.to_double(), hit.vy.to_double());
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    a.texts[i].push((hit.*coordinates[i].value).text(a.digits));
}

void CertifiedArchive::finish(const CertifiedEnd& end, const CertifiedEffort& effort,
                              const std::string& status, bool complete) {
  Implementation& a = *implementation_;
  a.rows.close();
  for (TextColumn& column : a.texts) column.close();
  hdf5::check(a.collisions.close(), a.target);
  a.write_end(end);
  {
    const Handle group =
        a.file.group("guarantee", "Every decimal is right: errors are below 10^-digits");
    const hid_t to = group.get();
    hdf5::write_attribute(to, "digits", std::int64_t{a.digits}, a.target);
    hdf5::write_attribute(to, "bits", std::int64_t{effort.bits}, a.target);
    hdf5::write_attribute(to, "attempts", std::int64_t{effort.attempts}, a.target);
    hdf5::write_attribute(to, "lost_bits", effort.tangent_bits, a.target);
    hdf5::write_attribute(to, "rescaled", std::int64_t{effort.rescaled}, a.target);
    hdf5::write_attribute(to, "reason", std::string_view(end.reason), a.target);
    if (!end.ties.empty()) hdf5::write_attribute(to, "ties", end.ties, a.target);
    if (!a.holes.empty()) hdf5::write_attribute(to, "holes", a.holes, a.target);
  }
  a.file.finish(status, complete);
  a.lock.reset();
}

namespace {

CertifiedFate fate_of(const std::string& status, const std::string& file) {
  for (int i = 0; i <= static_cast<int>(CertifiedFate::interrupted); ++i)
    if (status == name_of(static_cast<CertifiedFate>(i))) return static_cast<CertifiedFate>(i);
  throw InputError(Place{file, 0, 0, ""}, "a certified run does not end as '" + status + "'",
                   "an archive as carom wrote it");
}

void read_end(hid_t file, const std::string& name, StoredCertified& stored) {
  const Handle group = open_group(file, "state", name);
  const auto integer = [&](const char* column) {
    return read_number<std::int64_t>(group.get(), column, name);
  };
  CertifiedEnd& end = stored.end;
  end.fate = fate_of(hdf5::read_string_attribute(file, "status", name), name);
  end.collisions = static_cast<std::uint64_t>(integer("hits"));
  end.wall = static_cast<int>(integer("last_wall"));
  end.hole = static_cast<int>(integer("hole"));
  end.cell = {integer("cell_first"), integer("cell_second")};
  if (!hdf5::has(group.get(), coordinates.front().decimals)) return;
  for (const Coordinate& c : coordinates)
    end.*c.value = CertifiedNumber::of_text(hdf5::read_text(group.get(), c.decimals, name),
                                            stored.task.digits, Place{name, 0, 0, c.decimals});
}

void read_guarantee(hid_t file, const std::string& name, StoredCertified& stored) {
  const Handle group = open_group(file, "guarantee", name);
  const hid_t from = group.get();
  const auto integer = [&](const char* key) {
    return hdf5::read_attribute<std::int64_t>(from, key, name);
  };
  stored.task.digits = static_cast<int>(integer("digits"));
  stored.effort.bits = integer("bits");
  stored.effort.attempts = static_cast<int>(integer("attempts"));
  stored.effort.tangent_bits = hdf5::read_attribute<double>(from, "lost_bits", name);
  stored.effort.rescaled = integer("rescaled") != 0;
  stored.end.reason = hdf5::read_string_attribute(from, "reason", name);
  stored.end.ties = hdf5::read_string_list_attribute(from, "ties", name);
}

std::vector<CertifiedHit> read_collisions(hid_t file, const std::string& name, int digits) {
  const Handle group = open_group(file, "collisions", name);
  const hid_t from = group.get();
  const auto number = hdf5::read_column<std::uint64_t>(from, "number", name);
  const auto wall = hdf5::read_column<std::int32_t>(from, "wall", name);
  const auto first = hdf5::read_column<std::int64_t>(from, "cell_first", name),
             second = hdf5::read_column<std::int64_t>(from, "cell_second", name);
  std::vector<CertifiedHit> hits(number.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    hits[i].number = number[i];
    hits[i].wall = wall.at(i);
    hits[i].cell = {first.at(i), second.at(i)};
  }
  for (const Coordinate& c : coordinates) {
    const auto texts = hdf5::read_texts(from, c.decimals, name);
    for (std::size_t i = 0; i < hits.size(); ++i)
      hits[i].*c.value =
          CertifiedNumber::of_text(texts.at(i), digits, Place{name, 0, 0, c.decimals});
  }
  return hits;
}

}  // namespace

StoredCertified read_certified(const std::string& name) {
  const Handle file = open_kind(name, certified_archive_kind, "the archive holds no certified run",
                                "one written by carom run --precision certified -o");
  StoredCertified stored;
  read_head(file.get(), name, stored, stored);
  read_guarantee(file.get(), name, stored);
  read_end(file.get(), name, stored);
  stored.hits = read_collisions(file.get(), name, stored.task.digits);
  return stored;
}

}  // namespace carom
