#pragma once

namespace hires::physics {

/// A solid upright cylinder on a flat ground, for comparison with theory.
struct UprightCylinder {
  double radius{0.037};  ///< r [m]
  double height{0.274};  ///< h [m]; the centre of mass is at c = h / 2
  double mass{0.140};    ///< m [kg]
};

/// Horizontal acceleration of the ground at which it starts to tip: a = g r / c [m/s^2].
double TippingAcceleration(const UprightCylinder& body, double gravity);

/// ... at which it starts to slide: a = mu g [m/s^2].
double SlidingAcceleration(double friction, double gravity);

/// Speed of the ground from which a sudden stop topples it without slip [m/s]:
/// v = sqrt(2 g (R - c) I_A / m) / c with R = hypot(r, c), I_A = I_cm + m R^2.
double SuddenStopTopplingSpeed(const UprightCylinder& body, double gravity);

/// ... of any body.
/// @param support     r [m] from below its centre of mass to the edge that it topples over
/// @param com_height  c [m]
/// @param gyration    square of its radius of gyration about its centre of mass, I_cm / m [m^2]
double SuddenStopTopplingSpeed(double support, double com_height, double gyration, double gravity);

/// Shortest pulse of constant ground acceleration `a` [m/s^2] that overturns it without slip [s].
/// From the nonlinear rocking equation I_A theta'' = -m g R sin(alpha - theta) + m a R cos(alpha -
/// theta), integrated numerically (Runge-Kutta 4, step 1e-5 s), theta'' = 0 at rest for a below the
/// tipping acceleration.  @pre a > TippingAcceleration.
double OverturningPulseDuration(const UprightCylinder& body, double acceleration, double gravity);

/// The same by the linearised criterion of [Housner 1963, Bull. Seism. Soc. Am. 53:403-417],
/// cosh(p t) = 1 + 1 / (2 x (x - 1)), x = a / (g alpha), p = sqrt(m g R / I_A).
double HousnerPulseDuration(const UprightCylinder& body, double acceleration, double gravity);

}  // namespace hires::physics
