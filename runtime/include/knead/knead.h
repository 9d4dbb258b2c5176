/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Knead's C interface: load an asset, step, read the force.
 *
 * Plain C (C99 and later, C++ too). SI units: metres, newtons, seconds, kilograms; right-handed scene frame;
 * quaternions as w, x, y, z. No function throws, exits or prints.
 *
 * Versioning: every struct but knead_pose starts with `struct_size`, set by its init function. Later versions
 * only append members; a library older than the caller leaves members it does not know alone.
 *
 * Threads: one thread at a time per handle; different handles are independent. What is called between load
 * and free never allocates, locks or does I/O.
 */
#ifndef KNEAD_KNEAD_H
#define KNEAD_KNEAD_H

#include <stddef.h>
#include <stdint.h>

#include "knead/runtime/export.h"

#ifdef __cplusplus
#define KNEAD_NOEXCEPT noexcept
extern "C" {
#else
#define KNEAD_NOEXCEPT
#endif

/* Zero, or the number of the library's error; never renumbered. */
typedef enum knead_error {
    KNEAD_OK = 0,
    KNEAD_ERROR_IO = 1,                  /* cannot open, read or find the file */
    KNEAD_ERROR_NOT_KNEAD = 2,           /* not an HDF5 file, or one without Knead's header */
    KNEAD_ERROR_VERSION_UNSUPPORTED = 3, /* file written by a newer format */
    KNEAD_ERROR_FEATURE_UNSUPPORTED = 4, /* file needs a feature this library does not know */
    KNEAD_ERROR_WRONG_KIND = 5,          /* a Knead file, but not an asset */
    KNEAD_ERROR_MISSING = 6,
    KNEAD_ERROR_WRONG_TYPE = 7,
    KNEAD_ERROR_WRONG_EXTENT = 8,
    KNEAD_ERROR_TOO_LARGE = 9,
    KNEAD_ERROR_FORBIDDEN = 10,
    KNEAD_ERROR_CORRUPT = 11,
    KNEAD_ERROR_INVALID_DATA = 12,
    KNEAD_ERROR_CANNOT_WRITE = 13,
    KNEAD_ERROR_OUT_OF_MEMORY = 14,
    KNEAD_ERROR_INVALID_ARGUMENT = 15 /* null pointer, unknown struct_size, config out of range */
} knead_error;

/* What happened in a step: bits of knead_step_result.status. Zero is a good step. */
enum {
    KNEAD_STEP_NOT_CONVERGED = 1, /* the solver stopped at its cap; the force is its best estimate */
    KNEAD_STEP_NOT_FINITE = 2,    /* the state would not be finite: force zero, last good state kept */
    KNEAD_STEP_BAD_INPUT = 4,     /* pose or dt not finite or out of range: force zero, state kept */
    KNEAD_STEP_CONTACT_CAP = 8,   /* the set of touched nodes had not settled at its cap */
    KNEAD_STEP_INSIDE_OUT = 16    /* tetrahedra are inside out: the force is the model's, no matter's */
};

/* knead_config.arithmetic: how a step computes. */
enum {
    KNEAD_ARITHMETIC_AUTOMATIC = 0, /* as fits the asset */
    KNEAD_ARITHMETIC_FLOAT32 = 1,
    KNEAD_ARITHMETIC_FLOAT64 = 2,
    KNEAD_ARITHMETIC_MIXED = 3 /* the state in float64, the solve in float32 */
};

/* Choices of the application; knead_config_init() sets the defaults. See knead/runtime/config.h. */
typedef struct knead_config {
    size_t struct_size;
    const size_t* tools; /* indices of the asset's tools that the poses move, each once; NULL: the first */
    size_t tool_count;
    double expected_dt_s;   /* the step that will be asked for most: what loading prepares for */
    double force_tolerance; /* relative, of one step */
    int32_t max_solver_iterations;
    int32_t max_contact_passes;
    int32_t arithmetic;                /* KNEAD_ARITHMETIC_* */
    int32_t with_torque;               /* not 0: find the torque on each tool too */
    double coupling_stiffness_n_per_m; /* 0: no coupling, the tool is at the given pose */
    double coupling_damping_n_s_per_m;
    double tool_mass_kg;
    int32_t with_local_model;   /* not 0: knead_simulation_local_model() may be asked */
    int32_t max_linearisations; /* of one step; 0: as the matter needs */
} knead_config;

/* Position and orientation of a tool in the scene. */
typedef struct knead_pose {
    double position_m[3];
    double orientation_wxyz[4]; /* unit quaternion, tool frame to scene */
} knead_pose;

/* What one step yields for one tool; knead_step_result_init() sets struct_size. */
typedef struct knead_step_result {
    size_t struct_size;
    double force_n[3];   /* on the hand */
    double torque_nm[3]; /* likewise, about the tool's origin; zero unless asked for */
    double tool_position_m[3];
    uint32_t touched_nodes;
    uint32_t status; /* KNEAD_STEP_* bits of the whole step */
    uint32_t solver_iterations;
} knead_step_result;

/* What the object answers near where a tool stands: a linear view of the last step's end, for whoever renders
 * forces faster than the object is simulated. The force on the hand at a small twist d away (three
 * translations, three rotations about the tool's origin) is load - stiffness d - damping d' - mass d''.
 * Matrices are 6 x 6, row-major, symmetric, positive semidefinite; rows and columns of rotations are zero
 * unless torques are found. knead_local_model_init() sets struct_size. See knead/runtime/local_model.h. */
typedef struct knead_local_model {
    size_t struct_size;
    knead_pose origin;
    double force_n[3];
    double torque_nm[3];
    double stiffness[36];
    double damping[36];
    double mass[36];
    double normal[3]; /* unit, in which the object pushes; zero without contact */
    double radius_m;  /* how far from the origin the view is fair */
    uint64_t step;    /* since reset, from 1 */
    uint32_t touched_nodes;
    int32_t unilateral; /* not 0: the tool may leave; the force along the normal is never a pull */
} knead_local_model;

/* One soft object with its tools. */
typedef struct knead_simulation knead_simulation;

KNEAD_RUNTIME_API void knead_config_init(knead_config* config) KNEAD_NOEXCEPT;
KNEAD_RUNTIME_API void knead_step_result_init(knead_step_result* result) KNEAD_NOEXCEPT;
KNEAD_RUNTIME_API void knead_local_model_init(knead_local_model* model) KNEAD_NOEXCEPT;

/* Reads an asset. On success *out is a handle for knead_simulation_free(); otherwise *out is NULL and
 * knead_last_error(NULL) says why. config may be NULL: defaults. The path is UTF-8. */
KNEAD_RUNTIME_API knead_error knead_simulation_load(const char* asset_path, const knead_config* config,
                                                    knead_simulation** out) KNEAD_NOEXCEPT;

/* NULL is allowed. */
KNEAD_RUNTIME_API void knead_simulation_free(knead_simulation* simulation) KNEAD_NOEXCEPT;

/* Advances by dt_s (0.25e-3 to 20e-3) with the only tool, or the hand if coupled, at this position at the end
 * of the step. orientation_wxyz may be NULL: the tool's rest orientation. Returns KNEAD_OK also when
 * result->status has bits set; KNEAD_ERROR_INVALID_ARGUMENT only for null pointers, an unset struct_size or
 * several tools. */
KNEAD_RUNTIME_API knead_error knead_simulation_step(knead_simulation* simulation, const double position_m[3],
                                                    const double orientation_wxyz[4], double dt_s,
                                                    knead_step_result* result) KNEAD_NOEXCEPT;

/* The same for all tools. poses, results: [knead_simulation_tool_count()], in the order of the config's
 * tools; each result has its struct_size set, the same for all. */
KNEAD_RUNTIME_API knead_error knead_simulation_step_tools(knead_simulation* simulation,
                                                          const knead_pose* poses, double dt_s,
                                                          knead_step_result* results) KNEAD_NOEXCEPT;

/* After a step. May take as long as several steps where the set of touched nodes has just changed. The config
 * must have asked for it. */
KNEAD_RUNTIME_API knead_error knead_simulation_local_model(knead_simulation* simulation, size_t tool,
                                                           knead_local_model* model) KNEAD_NOEXCEPT;

/* Back to the rest state, at rest. */
KNEAD_RUNTIME_API knead_error knead_simulation_reset(knead_simulation* simulation) KNEAD_NOEXCEPT;

/* A tool's rest pose from the asset: start here. */
KNEAD_RUNTIME_API knead_error knead_simulation_rest_pose(const knead_simulation* simulation, size_t tool,
                                                         knead_pose* pose) KNEAD_NOEXCEPT;

KNEAD_RUNTIME_API size_t knead_simulation_tool_count(const knead_simulation* simulation) KNEAD_NOEXCEPT;
KNEAD_RUNTIME_API size_t knead_simulation_node_count(const knead_simulation* simulation) KNEAD_NOEXCEPT;
KNEAD_RUNTIME_API size_t knead_simulation_tetrahedron_count(const knead_simulation* simulation)
    KNEAD_NOEXCEPT;

/* node_count x 3 current positions, asset node order, computed by this call and valid until the next one of
 * any kind on this handle. NULL for NULL. */
KNEAD_RUNTIME_API const double* knead_simulation_positions_m(const knead_simulation* simulation)
    KNEAD_NOEXCEPT;

/* node_count x 3 current velocities, asset node order. */
KNEAD_RUNTIME_API knead_error knead_simulation_velocities_m_per_s(const knead_simulation* simulation,
                                                                  double* out) KNEAD_NOEXCEPT;

/* Text of the last call on this handle that did not return KNEAD_OK; with NULL: of the last failed load on
 * this thread. Never NULL, empty if there was none; valid until the next call of that kind. */
KNEAD_RUNTIME_API const char* knead_last_error(const knead_simulation* simulation) KNEAD_NOEXCEPT;

/* "io_error", ...; "unknown" for other numbers. */
KNEAD_RUNTIME_API const char* knead_error_name(knead_error error) KNEAD_NOEXCEPT;

/* "not_converged", ... of the lowest bit that is set; "ok" for zero, "unknown" for other bits. */
KNEAD_RUNTIME_API const char* knead_step_status_name(uint32_t status) KNEAD_NOEXCEPT;

/* Version of the library, "0.1.0". */
KNEAD_RUNTIME_API const char* knead_version(void) KNEAD_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* KNEAD_KNEAD_H */
