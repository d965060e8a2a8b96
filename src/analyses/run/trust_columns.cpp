#include "analyses/run/trust_columns.hpp"

#include "carom/base/error.hpp"

namespace carom::analyses {

using namespace files;
using hdf5::Handle;

namespace {

constexpr std::size_t entries = 5;  // of an error

OrbitError orbit_error(const double* d) { return {{d[0], d[1]}, {d[2], d[3]}, d[4]}; }

template <class T>
void write(hid_t group, const char* name, const std::vector<T>& values, const std::string& file) {
  Handle dataset = hdf5::checked(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, file);
  hdf5::check(H5Dwrite(dataset.get(), hdf5::native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                       values.data()) >= 0,
              file);
  hdf5::check(dataset.close(), file);
}

}  // namespace

void create_trust(hid_t group, std::size_t particles, const std::string& file) {
  const auto create = [&](const char* name, hid_t type, std::size_t rows,
                          hdf5::Description description) {
    hdf5::create_fixed(group, name, type, rows, description, file);
  };
  create("collisions", H5T_NATIVE_INT64, particles,
         {"1", "Reflections before the first whose estimated error is too large"});
  create("time", H5T_NATIVE_DOUBLE, particles, {"time", "Until when the particle can be trusted"});
  create("open", H5T_NATIVE_INT32, particles, {"1", "1: up to the last event"});
  create("error", H5T_NATIVE_DOUBLE, entries * particles,
         {"mixed",
          "While open: errors of x, y, vx, vy and t after the last event, rows 5 i to 5 i + 4"});
}

void write_trust(hid_t group, const std::vector<RunEnd>& particles, const std::string& file) {
  std::vector<std::int64_t> collisions;
  std::vector<double> time, error;
  std::vector<std::int32_t> open;
  for (const RunEnd& p : particles) {
    collisions.push_back(static_cast<std::int64_t>(p.trust.hits));
    time.push_back(p.trust.time.value());
    open.push_back(p.trust.open ? 1 : 0);
    const OrbitError& d = p.progress.trust.error;
    for (const double entry : {d.position.x, d.position.y, d.velocity.x, d.velocity.y, d.time})
      error.push_back(entry);
  }
  write(group, "collisions", collisions, file);
  write(group, "time", time, file);
  write(group, "open", open, file);
  write(group, "error", error, file);
}

void read_trust(hid_t group, std::vector<ParticleProgress>& particles, const std::string& file) {
  const auto collisions = hdf5::read_column<std::int64_t>(group, "collisions", file);
  const auto time = hdf5::read_column<double>(group, "time", file);
  const auto open = hdf5::read_column<std::int32_t>(group, "open", file);
  const auto error = hdf5::read_column<double>(group, "error", file);
  if (error.size() != entries * particles.size())
    throw InputError(Place{file, 0, 0, "/trust"}, "the datasets differ in length");
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Trust& trust = particles[i].trust;
    trust.known = true;
    trust.open = open.at(i) != 0;
    trust.hits = static_cast<std::uint64_t>(collisions.at(i));
    trust.time = trust.open ? particles[i].state.time : Time(time.at(i));
    trust.error = orbit_error(&error[entries * i]);
  }
}

}  // namespace carom::analyses
