// Plots as SVG, from data, for a file of their own or within a page. Axes and text are grey tones
// visible on light and dark backgrounds.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace sunder::scenes {

struct Axis {
  std::string name;
  bool logarithmic = false;
};

struct Axes {
  std::string title;
  Axis x, y;
};

/// A point of a curve. Values that cannot be shown on the axis are drawn at its end.
struct PlotPoint {
  double x = 0, y = 0;
  std::string label = {};  ///< Text beside the point; empty: none.
  std::string note = {};   ///< Tooltip.
};

/// Points of one colour, in order.
struct Curve {
  std::string name;  ///< Legend text; empty: none.
  std::vector<PlotPoint> points;
  bool line = true;   ///< Draws a line through the points.
  bool dots = false;  ///< Draws a dot at each point.
};

/// Returns a plot of curves with common axes.
std::string svg_curves(const Axes& axes, std::span<const Curve> curves);

struct Bar {
  std::string name;
  double value = 0;
};
/// Returns a bar chart, with bars from zero.
std::string svg_bars(const Axes& axes, std::span<const Bar> bars);

}  // namespace sunder::scenes
