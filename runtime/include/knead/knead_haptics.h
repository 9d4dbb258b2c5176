/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Knead's haptic loop in C: from an asset and a device to forces on a hand, with coupling and safety chain.
 *
 * Manners as in knead/knead.h: plain C, SI units, every struct begins with struct_size (set by its init
 * function) and only grows at its end, no function throws, exits or prints. What the numbers mean in full:
 * knead/haptics/haptic_loop.h, coupling.h, safety.h; the contract of safety: docs/safety.md.
 *
 * Link libknead_haptics and libknead_runtime.
 */
#ifndef KNEAD_KNEAD_HAPTICS_H
#define KNEAD_KNEAD_HAPTICS_H

#include "knead/haptics/export.h"
#include "knead/knead.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What acted on the force: bits of knead_haptic_tick.haptic_status. Zero: nothing. */
enum {
    KNEAD_HAPTIC_SATURATED = 1 << 0,    /* force or torque was longer than its limit: shortened */
    KNEAD_HAPTIC_NOT_FINITE = 1 << 1,   /* the force was not finite: zero was written */
    KNEAD_HAPTIC_PASSIVITY = 1 << 2,    /* the passivity controller took energy out */
    KNEAD_HAPTIC_SLEW_LIMITED = 1 << 3, /* the force would have changed faster than allowed */
    KNEAD_HAPTIC_RAMPING = 1 << 4,      /* rising after engaging or after a jump */
    KNEAD_HAPTIC_STALE_MODEL = 1 << 5,  /* no new result of the simulation: fading, then zero */
    KNEAD_HAPTIC_STALE_DEVICE = 1 << 6, /* no new sample of the device: fading, then zero */
    KNEAD_HAPTIC_BAD_POSE = 1 << 7,     /* the device's pose was none: zero was written */
    KNEAD_HAPTIC_POSE_JUMP = 1 << 8,    /* the device moved farther than a hand can */
    KNEAD_HAPTIC_TIME_JUMP = 1 << 9,    /* the period was far from the expected one */
    KNEAD_HAPTIC_STEP_FAILED = 1 << 10  /* the simulation's step failed: its force is not used */
};

/* knead_haptic_config.mode: where the simulation's step runs. */
enum {
    KNEAD_HAPTIC_SYNCHRONOUS = 0, /* in the haptic period */
    KNEAD_HAPTIC_TWO_RATE = 1     /* in a thread of its own */
};

/* knead_haptic_config.rendering: what a two-rate loop makes of the simulation's newest result. */
enum { KNEAD_RENDER_REDUCED_OBJECT = 0, KNEAD_RENDER_LINEAR = 1, KNEAD_RENDER_HOLD = 2 };

/* What a device says at one moment, in its own frame. time_s must advance with each new sample: a device
 * whose clock stands still is taken for dead and its force fades to zero. */
typedef struct knead_device_state {
    double position_m[3];
    double orientation_wxyz[4]; /* 1 0 0 0 if it has none */
    double velocity_m_per_s[3]; /* 0 0 0 if it does not measure it */
    double time_s;
    uint32_t buttons;
} knead_device_state;

/* A device: two functions that are called once a period on the haptic thread, with `user` handed through.
 * They must not block, and must live as long as the loop. The state is preset with zeros and a unit
 * quaternion. */
typedef struct knead_device {
    void* user;
    void (*read)(void* user, knead_device_state* state);
    void (*write)(void* user, const double force_n[3], const double torque_nm[3]);
} knead_device;

typedef struct knead_haptic_config {
    size_t struct_size;
    size_t tool; /* index of the asset's tool that the hand holds */
    /* Device to scene: position = offset + scale * rotation * device position. */
    double workspace_scale;
    double workspace_rotation_wxyz[4];
    double workspace_offset_m[3];
    double force_scale;        /* device newtons per scene newton */
    double rate_hz;            /* of the haptic side, 500 to 4000 */
    double simulation_rate_hz; /* two-rate only */
    int32_t mode;              /* KNEAD_HAPTIC_* */
    int32_t rendering;         /* KNEAD_RENDER_* */
    /* The coupling between hand and tool, in the scene; no rotation stiffness: three degrees of freedom. */
    double coupling_stiffness_n_per_m;
    double coupling_damping_n_s_per_m;
    double coupling_rotation_stiffness_nm_per_rad;
    double coupling_rotation_damping_nm_s_per_rad;
    /* Limits of what reaches the hand. */
    double max_force_n;
    double max_torque_nm;
    double slew_n_per_ms;
    double ramp_n_per_s;
    int32_t passivity_control; /* not 0: on */
    int32_t realtime_priority; /* not 0: ask for it */
} knead_haptic_config;

/* One period of the loop. */
typedef struct knead_haptic_tick {
    size_t struct_size;
    uint64_t number; /* from 1 */
    double dt_s;
    knead_device_state device;
    knead_pose hand;          /* scene frame */
    knead_pose tool;          /* likewise: where the tool is */
    double device_force_n[3]; /* as written */
    double device_torque_nm[3];
    uint32_t haptic_status; /* KNEAD_HAPTIC_* bits */
    uint32_t step_status;   /* KNEAD_STEP_* bits */
    uint32_t touched_nodes;
} knead_haptic_tick;

/* What a run was like. */
typedef struct knead_run_statistics {
    size_t struct_size;
    uint64_t ticks;
    double seconds;
    double rate_hz;
    double jitter_s; /* root mean square of a tick's start against its schedule */
    double tick_p50_s, tick_p99_s, tick_p999_s, tick_max_s;
    uint64_t misses;           /* ticks that ended after their period */
    uint64_t misses_preempted; /* of them: the machine did not run us */
    uint32_t haptic_status;    /* of all ticks together */
    uint32_t step_status;      /* likewise */
    int32_t realtime_priority; /* not 0: given */
} knead_run_statistics;

/* A loop with its own object. */
typedef struct knead_haptic_loop knead_haptic_loop;

KNEAD_HAPTICS_API void knead_haptic_config_init(knead_haptic_config* config) KNEAD_NOEXCEPT;
KNEAD_HAPTICS_API void knead_haptic_tick_init(knead_haptic_tick* tick) KNEAD_NOEXCEPT;
KNEAD_HAPTICS_API void knead_run_statistics_init(knead_run_statistics* statistics) KNEAD_NOEXCEPT;

/* Reads an asset and makes a loop between it and the device. The device is copied, `user` is not looked at.
 * config may be NULL: defaults. On success *out is for knead_haptic_loop_free(); otherwise it is NULL and
 * knead_haptic_last_error(NULL) says why. */
KNEAD_HAPTICS_API knead_error knead_haptic_loop_load(const char* asset_path,
                                                     const knead_haptic_config* config,
                                                     const knead_device* device,
                                                     knead_haptic_loop** out) KNEAD_NOEXCEPT;
/* Stops it first. NULL is allowed. */
KNEAD_HAPTICS_API void knead_haptic_loop_free(knead_haptic_loop* loop) KNEAD_NOEXCEPT;

/* Where the tool is in the asset at rest, scene frame: bring the hand there, or set workspace_offset_m so. */
KNEAD_HAPTICS_API knead_error knead_haptic_loop_rest_pose(const knead_haptic_loop* loop,
                                                          knead_pose* pose) KNEAD_NOEXCEPT;

/* On threads of its own until stop, which writes zero force before it returns. */
KNEAD_HAPTICS_API knead_error knead_haptic_loop_start(knead_haptic_loop* loop) KNEAD_NOEXCEPT;
KNEAD_HAPTICS_API knead_error knead_haptic_loop_stop(knead_haptic_loop* loop) KNEAD_NOEXCEPT;

/* One period in the caller's own loop instead; tick may be NULL. Two-rate loops cannot be driven so. */
KNEAD_HAPTICS_API knead_error knead_haptic_loop_tick(knead_haptic_loop* loop, double dt_s,
                                                     knead_haptic_tick* tick) KNEAD_NOEXCEPT;

/* Of the run that is on, or of the last one. From any thread. */
KNEAD_HAPTICS_API knead_error knead_haptic_loop_statistics(const knead_haptic_loop* loop,
                                                           knead_run_statistics* statistics) KNEAD_NOEXCEPT;

/* As knead_last_error(): of this loop, or with NULL of the last failed load on this thread. */
KNEAD_HAPTICS_API const char* knead_haptic_last_error(const knead_haptic_loop* loop) KNEAD_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* KNEAD_KNEAD_HAPTICS_H */
