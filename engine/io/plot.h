// Plots as SVG: what is drawn is said as data, and comes out as a picture that stands alone in a
// file or within a page. Axes and words take a grey that shows on light and on dark.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace sunder {

struct Axis {
  std::string name;
  bool logarithmic = false;
};

struct Axes {
  std::string title;
  Axis x, y;
};

/// A point of a curve. What is not finite, or not positive on a logarithmic axis, is drawn at that
/// end of the axis.
struct PlotPoint {
  double x = 0, y = 0;
  std::string label = {};  ///< Written beside it; none if empty.
  std::string note = {};   ///< Shown to who points at it.
};

/// Points of one colour, in order.
struct Curve {
  std::string name;  ///< In the legend; none if empty.
  std::vector<PlotPoint> points;
  bool line = true;   ///< Through the points.
  bool dots = false;  ///< At the points.
};

/// Curves over common axes: a scatter, a front, a series of times.
std::string svg_curves(const Axes& axes, std::span<const Curve> curves);

struct Bar {
  std::string name;
  double value = 0;
};
/// A bar for each, from zero up: counts of a histogram, or figures to compare.
std::string svg_bars(const Axes& axes, std::span<const Bar> bars);

}  // namespace sunder
