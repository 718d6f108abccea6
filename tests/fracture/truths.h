// The truths that every fracture must keep, checked from first principles.
#pragma once

#include <string>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Empty if all is true of a break of `parent`; otherwise what is not.
std::string broken_truth(const Compound& parent, const BreakPlan& plan);

/// The contacts of a compound by the paper's method: faces sorted by |d| of their planes, every
/// pair of like |d| checked. Slow where many faces share |d|; an oracle.
std::vector<Bond> contacts_by_distance(const Compound& compound, double tolerance);

}  // namespace sunder::fracture
