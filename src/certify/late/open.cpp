// FLINT binds ten thousand of its own calls when it is loaded, some milliseconds that most runs
// would wait for in vain. So programs and the Python module open it when certified numbers are
// first asked for; calls.S has its functions until then.
#include <dlfcn.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "certify/number/ball.hpp"

// What calls.S is made of.
struct CaromFlintCall {
  void* found;
  const char* name;
};
extern "C" {
extern CaromFlintCall carom_flint_calls[], carom_flint_calls_end[];
void carom_open_flint_or_end() noexcept;
}

namespace {

void nothing() {}

// Numbers that nothing was written into are ended on the way out.
[[noreturn]] void refuse() {
  const char* reason = ::dlerror();
  for (CaromFlintCall* call = carom_flint_calls; call != carom_flint_calls_end; ++call)
    if (std::strstr(call->name, "_clear") != nullptr)
      call->found = reinterpret_cast<void*>(nothing);
  throw std::system_error(ELIBACC, std::generic_category(),
                          "certified runs, and how far others can be trusted, need FLINT (" +
                              std::string(reason != nullptr ? reason : CAROM_FLINT) + ")");
}

// A wheel brings its own libraries under names of their own (bundle.sh).
void* library() {
  for (const char* name : {"carom_" CAROM_FLINT, CAROM_FLINT})
    if (void* opened = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return opened;
  refuse();
}

bool find_calls() {
  void* flint = library();
  for (CaromFlintCall* call = carom_flint_calls; call != carom_flint_calls_end; ++call)
    if ((call->found = ::dlsym(flint, call->name)) == nullptr) refuse();
  return true;
}

void open() { [[maybe_unused]] static const bool once = find_calls(); }

[[maybe_unused]] const bool known = (carom::certify::open_flint = open, true);

}  // namespace

// Where no Precision has opened it, and a function in C cannot throw.
void carom_open_flint_or_end() noexcept {
  try {
    open();
  } catch (const std::system_error& error) {
    std::fprintf(stderr, "carom: %s\n", error.what());
    std::_Exit(1);
  }
}
