// The tables and watchers of all tests, under the name of those of the event loop.
#pragma once

#include "events/recorder.hpp"

namespace carom::test {
using namespace carom::tests;
}
