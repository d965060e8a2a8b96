// The archives of ensembles.
#include "ensemble/describe/diffusion.hpp"
#include "ensemble/describe/escape.hpp"
#include "ensemble/describe/lyapunov.hpp"
#include "io/describe/archive_in.hpp"
#include "io/describe/archive_out.hpp"

namespace carom::io {

template <class Result>
void write_counts(const ArchiveFile& file, const Result& result, const System& system) {
  ArchiveOut out(file);
  ensemble::describe(out, result, system);
}
template <class Result>
void read_counts(hid_t file, const std::string& name, Result& result) {
  ArchiveIn in(file, name);
  ensemble::describe(in, result, System());
}

#define CAROM_MAKE(Result)                                                      \
  template void write_counts(const ArchiveFile&, const Result&, const System&); \
  template void read_counts(hid_t, const std::string&, Result&);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

}  // namespace carom::io
