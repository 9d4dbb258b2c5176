/* SPDX-License-Identifier: Apache-2.0 */
/* c_loop ASSET: a haptic loop in plain C, with a device of three lines in place of a real one. */
#include <stdio.h>

#include "knead/knead_haptics.h"

/* A hand that goes 5 mm into the object within half a second and stays. */
typedef struct hand {
    double start_m[3];
    double time_s;
    double force_n;
} hand;

static void read_hand(void* user, knead_device_state* state) {
    hand* self = (hand*)user;
    const double share = self->time_s < 0.5 ? self->time_s / 0.5 : 1.0;
    self->time_s += 1e-3;
    state->time_s = self->time_s;
    state->position_m[0] = self->start_m[0];
    state->position_m[1] = self->start_m[1];
    state->position_m[2] = self->start_m[2] - 5e-3 * share;
}

static void write_hand(void* user, const double force_n[3], const double torque_nm[3]) {
    (void)torque_nm;
    ((hand*)user)->force_n = force_n[2];
}

int main(int argc, char** argv) {
    hand self = {{0, 0, 0}, 0, 0};
    const knead_device device = {&self, read_hand, write_hand};
    knead_haptic_loop* loop = NULL;
    knead_haptic_tick tick;
    knead_pose rest;
    int i, j;
    if (argc != 2) {
        fprintf(stderr, "Usage: c_loop ASSET\n");
        return 2;
    }
    if (knead_haptic_loop_load(argv[1], NULL, &device, &loop) != KNEAD_OK) {
        fprintf(stderr, "c_loop: error: %s\n", knead_haptic_last_error(NULL));
        return 3;
    }
    knead_haptic_loop_rest_pose(loop, &rest);
    for (j = 0; j < 3; ++j)
        self.start_m[j] = rest.position_m[j];
    knead_haptic_tick_init(&tick);
    /* With a real device: knead_haptic_loop_start(loop), wait, knead_haptic_loop_stop(loop). */
    for (i = 1; i <= 1000; ++i) {
        if (knead_haptic_loop_tick(loop, 1e-3, &tick) != KNEAD_OK) {
            fprintf(stderr, "c_loop: error: %s\n", knead_haptic_last_error(loop));
            break;
        }
        if (i % 100 == 0)
            printf("%.1f s  force %7.4f N%s\n", 1e-3 * i, self.force_n,
                   (tick.haptic_status & KNEAD_HAPTIC_SATURATED) != 0 ? "  (limit of the device)" : "");
    }
    knead_haptic_loop_free(loop);
    return i > 1000 ? 0 : 1;
}
