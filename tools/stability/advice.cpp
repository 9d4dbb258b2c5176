// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/stability.h"

namespace knead::tools::stability {

const char* name_of(CellStatus status) {
    switch (status) {
        case CellStatus::pass:
            return "pass";
        case CellStatus::warn:
            return "warn";
        case CellStatus::fail:
            return "fail";
    }
    return "";
}

const char* name_of(Warning warning) {
    switch (warning) {
        case Warning::none:
            return "none";
        case Warning::not_converged:
            return "not_converged";
        case Warning::contact_cap:
            return "contact_cap";
        case Warning::iterations:
            return "iterations";
        case Warning::step_force:
            return "step_force";
        case Warning::linearisation:
            return "linearisation";
        case Warning::force_at_rest:
            return "force_at_rest";
        case Warning::no_reference:
            return "no_reference";
        case Warning::locking:
            return "locking";
        case Warning::slivers:
            return "slivers";
        case Warning::dt_out_of_range:
            return "dt_out_of_range";
        case Warning::spin_loss:
            return "spin_loss";
        case Warning::hooked:
            return "hooked";
        case Warning::inside_out:
            return "inside_out";
    }
    return "";
}

const std::vector<Warning>& all_warnings() {
    static const std::vector<Warning> all{
        Warning::not_converged, Warning::contact_cap,     Warning::iterations,   Warning::step_force,
        Warning::linearisation, Warning::force_at_rest,   Warning::no_reference, Warning::locking,
        Warning::slivers,       Warning::dt_out_of_range, Warning::spin_loss,    Warning::hooked,
        Warning::inside_out};
    return all;
}

Advice advice_for(Warning warning) {
    switch (warning) {
        case Warning::none:
            return {"", ""};
        case Warning::not_converged:
            return {
                "the solver stopped at its cap in some steps; they told it, and the velocities were set to "
                "zero so that nothing grows",
                "render such a step's force with care (the haptic loop's safety chain does); use a shorter "
                "dt or a slower hand, or less contrast"};
        case Warning::contact_cap:
            return {
                "the set of touched nodes did not settle within its limits in some steps; they told it",
                "use a shorter dt or a slower hand, or a surface mesh that is finer than the tool is curved"};
        case Warning::iterations:
            return {
                "the object needs many solver iterations a step; the force is right, the step is slow",
                "watch the step time: use a shorter dt, less contrast, a Poisson's ratio below 0.49, or a "
                "coarser mesh; or run the simulation slower than the haptic loop"};
        case Warning::step_force:
            return {"the force of some steps is off by more than 1e-3 but less than 1e-2",
                    "lower SimulationConfig::force_tolerance if that is felt"};
        case Warning::linearisation:
            return {
                "one linearisation a step: the motion within one step is large, and the force of the "
                "converged "
                "nonlinear step is another one; it is exact again once the motion slows down",
                "use a shorter dt or a slower tool; for presses of half the height in a few steps, substep"};
        case Warning::force_at_rest:
            return {
                "the force of the object at rest is off by more than 1e-3 but less than 1e-2",
                "wait until it has come to rest, lower SimulationConfig::force_tolerance, or choose float64 "
                "(SimulationConfig::arithmetic)"};
        case Warning::no_reference:
            return {
                "the reference solver found no answer for some of the comparisons (a body so deformed that "
                "Newton's method fails): nothing is said about those forces",
                "judge by the other checks; do not rely on forces in such states"};
        case Warning::locking:
            return {
                "linear tetrahedra lock as Poisson's ratio comes near 0.5: the mesh, not the solver, is too "
                "stiff",
                "use a Poisson's ratio of 0.45 to 0.49 (the touch hardly differs), or a finer mesh, or lower "
                "Young's modulus so that the force fits a measurement"};
        case Warning::slivers:
            return {
                "very flat or thin tetrahedra make the mesh stiffer than a good one",
                "mesh again with a better quality (knead-mesh reports dihedral angles), or merge the nodes "
                "that nearly coincide"};
        case Warning::dt_out_of_range:
            return {
                "steps are 0.25 to 20 ms; others are refused as bad_input, with no force and the state as it "
                "was",
                "for less, collect time until 0.25 ms have passed; for more, run several steps of equal "
                "length with poses in between"};
        case Warning::spin_loss:
            return {"implicit Euler brakes a free spin, the more the longer dt is",
                    "use a shorter dt where a body flies freely; held objects do not spin"};
        case Warning::hooked:
            return {
                "the tool jumped into the object and out again: contact is of nodes against tools, not along "
                "the "
                "way, so some nodes are on the other side of the tool and go with it",
                "do not let a tool jump: the haptic loop refuses jumps of the hand; a coupling keeps the "
                "tool's "
                "speed finite; after a jump call reset()"};
        case Warning::inside_out:
            return {
                "the tool has turned tetrahedra inside out in some steps; they told it. Their forces are the "
                "model's, which jump where the nearest rotation does, so that there may be no rest",
                "do not press or pull matter beyond what it bears: limit the tool's way, or let go where the "
                "bit is told; a finer mesh spreads large strains over more tetrahedra"};
    }
    return {"", ""};
}

}  // namespace knead::tools::stability
