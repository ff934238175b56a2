/* Scores the pose of a linked-in file against a linked-in template, checks poses against a depth image, and
 * shows what is refused.
 *
 * Some of the file's correspondences are unsound, so that the answer on all of them is undecided; on
 * the sound ones alone there is a decision.
 *
 * The same on firmware and on a host. Prints the bits of every result, so that runs on different
 * processors can be compared. */

#include "cobra_infer.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* inputs.S; the template's bytes may lie at any address. */
extern const unsigned char template_start[], template_end[];
extern const unsigned char crowded_start[], crowded_end[];
extern const unsigned char points_start[], points_end[];
extern const unsigned char scene_start[];
extern const uint16_t image_start[], image_end[];

/* What a template damaged in RAM is copied to. */
static unsigned char damaged[256 * 1024];

/* All that the library needs of RAM besides its stack. 8 is both alignments of the header. */
static union {
    unsigned char bytes[COBRA_TEMPLATE_SIZE];
    uint64_t alignment;
} template_memory;
static union {
    unsigned char bytes[COBRA_SCORER_SIZE];
    uint64_t alignment;
} scorer_memory;


/* And for a depth buffer of the default size; the mask is the caller's own. */
static uint32_t cells[32 * 32 * COBRA_DEPTH_CELL_SIZE / sizeof(uint32_t)];
static CobraDepthPixel mask[128];

static const char *const reasons[] = {
    "not-scored",    "accept",         "below-threshold", "no-support",
    "behind-camera", "too-few-points", "no-weight",       "non-finite-input",
    "negative-weight", "no-threshold",
};

static uint32_t bits(float value)
{
    uint32_t result;
    memcpy(&result, &value, sizeof result);
    return result;
}

/* Reads from a file of little-endian numbers, on a little-endian processor. */
static const unsigned char *take(const unsigned char *from, void *to, size_t length)
{
    memcpy(to, from, length);
    return from + length;
}

static CobraStatus load(const unsigned char *start, const unsigned char *end,
                        CobraTemplate **loaded)
{
    return cobra_template_load(&template_memory, sizeof template_memory, start,
                               (size_t)(end - start), loaded);
}

static bool is_sound(const float numbers[6])
{
    int i;
    for (i = 0; i < 6; i++) {
        if (!isfinite(numbers[i])) {
            return false;
        }
    }
    return numbers[5] >= 0; /* the weight */
}

static CobraStatus score(CobraTemplate *loaded, bool only_sound)
{
    const unsigned char *next = points_start;
    CobraCamera camera;
    CobraPose pose;
    CobraSettings settings;
    CobraScorer *scorer;
    CobraReport report;
    CobraStatus status;
    uint32_t poses, count;

    next = take(next, camera.matrix, sizeof camera.matrix);
    next = take(next, &poses, sizeof poses);
    take(take(next, pose.rotation, sizeof pose.rotation), pose.translation,
         sizeof pose.translation);
    next += poses * (sizeof pose.rotation + sizeof pose.translation);
    next = take(next, &count, sizeof count);

    /* A tolerance of 2 mm; the camera and the estimator place a point to 0.5 units. */
    status = cobra_settings_default(loaded, 2.0f, &settings);
    if (status != COBRA_STATUS_OK) {
        return status;
    }
    settings.sigma = 0.5f;
    status = cobra_scorer_start(&scorer_memory, sizeof scorer_memory, loaded, &camera, &pose,
                                &settings, &scorer);
    if (status != COBRA_STATUS_OK) {
        return status;
    }
    while (count-- > 0) {
        float numbers[6];
        float likelihood;
        CobraCorrespondence correspondence;

        next = take(next, numbers, sizeof numbers);
        if (only_sound && !is_sound(numbers)) {
            continue;
        }
        correspondence.u = numbers[0];
        correspondence.v = numbers[1];
        correspondence.x = numbers[2];
        correspondence.y = numbers[3];
        correspondence.z = numbers[4];
        correspondence.weight = numbers[5];
        status = cobra_scorer_push(scorer, &correspondence, &likelihood);
        if (status != COBRA_STATUS_OK) {
            return status;
        }
        printf("%08" PRIx32 "\n", bits(likelihood));
    }
    status = cobra_scorer_finish(scorer, &report);
    if (status != COBRA_STATUS_OK) {
        return status;
    }
    printf("confidence %08" PRIx32 " threshold %08" PRIx32 " weight_sum %08" PRIx32
           " inlier_share %08" PRIx32 " points %" PRIu32 " behind_camera %" PRIu32 " decision %s\n",
           bits(report.confidence), bits(report.threshold), bits(report.weight_sum),
           bits(report.inlier_share), report.points, report.behind_camera,
           reasons[report.reason]);
    return next == points_end ? COBRA_STATUS_OK : COBRA_STATUS_LENGTH_TOO_LARGE;
}

/* Prints the bits of a report's numbers, and the rest of it. */
static void print(const CobraDepthReport *report)
{
    const float first[] = {report->confidence,   report->forward,  report->reverse, report->estimated_error,
                           report->displacement, report->residual, report->noise,   report->depth_ratio};
    const float last[] = {report->moved_along_ray, report->moved_sideways, report->turned, report->cause_value};
    size_t i;

    printf("depth");
    for (i = 0; i < sizeof first / sizeof *first; i++) {
        printf(" %08" PRIx32, bits(first[i]));
    }
    for (i = 0; i < 9; i++) {
        printf(" %08" PRIx32, bits(report->refined.rotation[i]));
    }
    for (i = 0; i < 3; i++) {
        printf(" %08" PRIx32, bits(report->refined.translation[i]));
    }
    for (i = 0; i < sizeof last / sizeof *last; i++) {
        printf(" %08" PRIx32, bits(last[i]));
    }
    printf(" %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32, report->pixels,
           report->silent, report->visible, report->judged, report->hidden, report->unmeasured,
           report->seen_through);
    printf(" cause %" PRIu32 ": %s\n", (uint32_t)report->cause, cobra_reason_string(report->reason));
}

/* Every pose of the scene against its image: by its mask, and by what the pose says is seen. */
static CobraStatus check(CobraTemplate *loaded)
{
    const unsigned char *next = scene_start;
    const unsigned char *poses;
    CobraCamera camera;
    CobraDepthSettings settings;
    CobraDepthObserved observed = {0};
    CobraStatus status;
    uint32_t width, pose_count, pixel_count, i;
    const uint32_t room = sizeof mask / sizeof *mask;
    int masked;

    next = take(next, camera.matrix, sizeof camera.matrix);
    next = take(next, &width, sizeof width);
    next = take(next, &observed.scale, sizeof observed.scale);
    poses = take(next, &pose_count, sizeof pose_count);
    next = take(poses + pose_count * sizeof(CobraPose), &pixel_count, sizeof pixel_count);
    observed.words = image_start;
    observed.width = (uint16_t)width;
    /* The scene is the program's own; a robot checks what comes from outside. */
    if (width == 0 || pixel_count > room) {
        return COBRA_STATUS_MEMORY_TOO_SMALL;
    }
    observed.height = (uint16_t)((size_t)(image_end - image_start) / width);
    for (i = 0; i < pixel_count; i++) {
        next = take(next, &mask[i].column, sizeof mask[i].column);
        next = take(next, &mask[i].row, sizeof mask[i].row);
        mask[i].depth = (float)image_start[mask[i].row * width + mask[i].column] * observed.scale;
    }
    status = cobra_depth_settings_default(loaded, &settings);
    for (i = 0; i < pose_count; i++) {
        CobraPose pose;

        poses = take(poses, pose.rotation, sizeof pose.rotation);
        poses = take(poses, pose.translation, sizeof pose.translation);
        for (masked = 1; masked >= 0; masked--) {
            CobraDepthReport report;

            observed.pixels = masked ? mask : NULL;
            observed.pixel_count = masked ? pixel_count : 0;
            if (status == COBRA_STATUS_OK) {
                status = cobra_depth_check(cells, sizeof cells, loaded, &camera, &pose, &settings,
                                           &observed, &report);
            }
            if (status != COBRA_STATUS_OK) {
                return status;
            }
            print(&report);
        }
    }
    return status;
}

int main(void)
{
    size_t length = (size_t)(template_end - template_start);
    CobraTemplate *loaded;
    CobraStatus status;

    status = load(template_start, template_end, &loaded);
    if (status == COBRA_STATUS_OK) {
        status = score(loaded, false);
    }
    if (status == COBRA_STATUS_OK) {
        status = score(loaded, true);
    }
    if (status != COBRA_STATUS_OK) {
        printf("failed: %s\n", cobra_status_string(status));
        return 1;
    }
    printf("depth: %s\n", cobra_status_string(check(loaded)));

    if (length > sizeof damaged) {
        printf("the template is larger than the example's buffer\n");
        return 1;
    }
    memcpy(damaged, template_start, length);
    damaged[length / 2] ^= 1;
    status = load(damaged, damaged + length, &loaded);
    printf("damaged: %s\n", cobra_status_string(status));
    if (status == COBRA_STATUS_OK || loaded != NULL) {
        return 1;
    }

    status = load(crowded_start, crowded_end, &loaded);
    if (status == COBRA_STATUS_OK) {
        status = score(loaded, false);
    }
    printf("crowded: %s\n", cobra_status_string(status));
    return status == COBRA_STATUS_OK;
}
