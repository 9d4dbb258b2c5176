// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

/// What a cell of the stability matrix is held to. Stated before any result was looked at (docs/stability.md
/// gives the reasons at length); a cell that misses one is mended or stays red, the number stays.
namespace knead::tools::stability::criteria {

// ---- Forces -------------------------------------------------------------------------------------------
/// Relative error of one step's force against the reference solver's solution of the same linearised step.
/// Above `kForceWrong` in a step that told nothing: fail. Above `kForceGood` (three times the default
/// force_tolerance, as a force is made of several such errors): warning.
inline constexpr double kForceWrong = 1e-2;
inline constexpr double kForceGood = 1e-3;
/// The same two bounds hold for the force of an object that has come to rest under the tool, against the
/// converged nonlinear equilibrium. A step against the converged nonlinear step above kForceWrong: warning.
///
/// Errors are relative to the reference's force, or to this share of the largest of the run where that is
/// larger: a force on its way through zero has no relative error.
inline constexpr double kSmallestForceShare = 0.01;
/// Steps longer than this may be linearised again (docs/simulation.md) and are then after the converged step:
/// the error of such a step is the smaller of the two.
inline constexpr double kMayLineariseAgain_s = 2.5e-3;
/// Steps compared in a run, evenly spread; fewer would miss the release, more cost minutes.
inline constexpr std::size_t kComparedSteps = 12;

// ---- Energy -------------------------------------------------------------------------------------------
/// The object may hold at most the work that the hand has done on it: net work (passive) and the sum of the
/// positive work (bounded), with this share of the positive work as slack, for work is force at a step's end
/// times the motion in it while energy is exact and nonlinear, and beside it the kinetic energy of the
/// velocity error that a step may make.
inline constexpr double kEnergySlack = 0.02;
inline constexpr double kVelocityError_m_per_s = 3e-4;
/// While the tools are still, energy may grow by no more than this share of the work done.
inline constexpr double kEnergyDrift = 1e-3;

// ---- Recovery -----------------------------------------------------------------------------------------
/// Root mean square distance from the rest shape after release, over the object's size: what the recovery
/// tests have asked since the first release.
inline constexpr double kOffRest = 1e-4;
/// Time for it, in times that a shear wave takes through the softest matter along the object. With critical
/// damping the first mode is down by e^-18.
inline constexpr double kRestTimes = 12;
/// A run longer than this is not made: recovery and force at rest are then said to be not judged.
inline constexpr std::size_t kMostSteps = 30'000;

// ---- Iterations and status ----------------------------------------------------------------------------
/// Mean of a run above which a warning is given: on 1,296 tetrahedra 30 iterations take about a third of a
/// haptic period.
inline constexpr double kMeanIterations = 30;
/// A step that tells not_converged or contact_cap is honest: warning. An object that does so in more than
/// this share of its steps is not usable: fail. (inside_out speaks of where the tool has taken the object: it
/// warns, for as long as the tool stays.)
inline constexpr double kToldShare = 0.1;

// ---- Contact ------------------------------------------------------------------------------------------
/// A unilateral tool that pulls, or Coulomb friction beyond its cone, as a share of the largest force: what
/// friction may miss (ten times the force tolerance), several nodes together.
inline constexpr double kContactLaw = 1e-2;
/// Penetration of a touchable node at the end of a step, over the object's size.
inline constexpr double kPenetration = 1e-4;
/// Force after the tool has left, as a share of the largest force.
inline constexpr double kForceAway = 1e-12;

// ---- Free flight --------------------------------------------------------------------------------------
/// Change of momentum, and growth of angular momentum or energy, over the flight, relative to what it was.
inline constexpr double kMomentum = 1e-3;
/// Loss of angular momentum in the flight above which a warning is given: implicit Euler brakes a spin.
inline constexpr double kSpinLoss = 0.1;

// ---- Meshes -------------------------------------------------------------------------------------------
/// Excess of the coarse mesh's force over that of the finer reference or the analytic value above which a
/// warning is given: the just noticeable difference of a force.
inline constexpr double kMeshError = 0.1;
/// Deviation from an analytic value that linear tetrahedra represent exactly.
inline constexpr double kAnalytic = 1e-3;

// ---- Soak ---------------------------------------------------------------------------------------------
/// Largest force and largest energy in the last tenth of a soak, over those of the first tenth after the
/// press: above one by at most this.
inline constexpr double kSoakGrowth = 0.01;

}  // namespace knead::tools::stability::criteria
