/// @file
/// The whole library: `#include <carom/carom.hpp>`. For geometry alone take <carom/geometry/…>.
#pragma once

#include "carom/analysis/survival.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/certify/plain_orbit.hpp"
#include "carom/ensemble/diffusion.hpp"
#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/paired_escape.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/section_run.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/events/world.hpp"
#include "carom/io/archive.hpp"
#include "carom/io/certified_archive.hpp"
#include "carom/io/system_file.hpp"
#include "carom/table/hole_names.hpp"
#include "carom/table/table.hpp"
