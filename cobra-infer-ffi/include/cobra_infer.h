/* The C interface of cobra-infer: scores 6D object poses against a Gaussian-process shape template.
 *
 * Made from the Rust source by cbindgen; its document, with a complete program, is docs/C.md.
 *
 * Every pointer must be NULL or point to what its type says; "points to" in what follows is a
 * promise of the caller's that the library cannot check. What it can check, it refuses by a status:
 * NULL, misaligned pointers, memory that is too small, enumerations out of range, handles that were
 * never made. No function keeps state outside of the memory it is given, allocates or blocks. */


#ifndef COBRA_INFER_H
#define COBRA_INFER_H

#include <stddef.h>
#include <stdint.h>
/* As the library was built; 32 unless the environment variable COBRA_MAX_COMPONENTS said otherwise. */
#ifndef COBRA_MAX_COMPONENTS
#define COBRA_MAX_COMPONENTS 32
#endif

/* Bytes that hold a scorer's handle on every processor. */
#define COBRA_SCORER_SIZE (COBRA_SCORER_BASE_SIZE + COBRA_SCORER_COMPONENT_SIZE * COBRA_MAX_COMPONENTS)


/**
 * Bytes that hold the name of any object and the zero behind it.
 */
#define COBRA_NAME_SIZE 33

/**
 * Bytes that hold a template's handle on every processor.
 */
#define COBRA_TEMPLATE_SIZE 192

/**
 * Alignment of a template's handle on every processor.
 */
#define COBRA_TEMPLATE_ALIGN 8

/**
 * Bytes that a scorer's handle takes on every processor, besides those for each component.
 */
#define COBRA_SCORER_BASE_SIZE 448

/**
 * Bytes that a scorer's handle takes for each component that it has room for.
 */
#define COBRA_SCORER_COMPONENT_SIZE 12

/**
 * Alignment of a scorer's handle on every processor.
 */
#define COBRA_SCORER_ALIGN 8

/**
 * In `CobraTemplateDetail`, a number that the status does not have.
 */
#define COBRA_NOT_APPLICABLE 4294967295

/**
 * Bytes of scratch memory that a check takes for each cell of its depth buffer, which has
 * `side` by `side` of them.
 */
#define COBRA_DEPTH_CELL_SIZE 4

/**
 * Alignment of that memory.
 */
#define COBRA_DEPTH_ALIGN 4

/**
 * What a call came to. Every function but the ones that only tell a size, a text or a constant
 * returns one.
 *
 * The numbers are part of the ABI: new ones are appended to their group, none is ever changed.
 */
enum CobraStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * It did what it should.
   */
  COBRA_STATUS_OK = 0,
  /**
   * A pointer that must not be NULL is.
   */
  COBRA_STATUS_NULL_POINTER = 1,
  /**
   * A pointer is not aligned as its type asks for.
   */
  COBRA_STATUS_MISALIGNED = 2,
  /**
   * The memory for a handle is smaller than the handle, or that for a depth buffer too small.
   */
  COBRA_STATUS_MEMORY_TOO_SMALL = 3,
  /**
   * Bytes, or the memory for a handle, would reach past the end of the address space.
   */
  COBRA_STATUS_LENGTH_TOO_LARGE = 4,
  /**
   * The memory for a handle overlaps something that the call reads or writes.
   */
  COBRA_STATUS_OVERLAP = 5,
  /**
   * The handle was never made, or making it failed.
   */
  COBRA_STATUS_NOT_READY = 6,
  /**
   * The bytes end before the template's header does.
   */
  COBRA_STATUS_TEMPLATE_HEADER_TRUNCATED = 100,
  /**
   * The bytes do not start with "CBRA".
   */
  COBRA_STATUS_TEMPLATE_MAGIC = 101,
  /**
   * This build reads another version of the format.
   */
  COBRA_STATUS_TEMPLATE_VERSION = 102,
  /**
   * The header's reserved bytes are not zero.
   */
  COBRA_STATUS_TEMPLATE_RESERVED = 103,
  /**
   * The number of bytes is not the length in the header.
   */
  COBRA_STATUS_TEMPLATE_LENGTH = 104,
  /**
   * The content is not what was written.
   */
  COBRA_STATUS_TEMPLATE_CHECKSUM = 105,
  /**
   * A section reaches past the end.
   */
  COBRA_STATUS_TEMPLATE_SECTION_TRUNCATED = 106,
  /**
   * A section that must be understood is unknown.
   */
  COBRA_STATUS_TEMPLATE_UNKNOWN_SECTION = 107,
  /**
   * A section's flags have an unknown bit.
   */
  COBRA_STATUS_TEMPLATE_SECTION_FLAGS = 108,
  /**
   * A section occurs twice.
   */
  COBRA_STATUS_TEMPLATE_DUPLICATE_SECTION = 109,
  /**
   * A required section is missing.
   */
  COBRA_STATUS_TEMPLATE_MISSING_SECTION = 110,
  /**
   * A section does not decode.
   */
  COBRA_STATUS_TEMPLATE_MALFORMED_SECTION = 111,
  /**
   * A section goes on behind its content.
   */
  COBRA_STATUS_TEMPLATE_TRAILING_BYTES = 112,
  /**
   * The component records have another length than this version's.
   */
  COBRA_STATUS_TEMPLATE_RECORD_LENGTH = 113,
  /**
   * An array's byte count is no multiple of its element's.
   */
  COBRA_STATUS_TEMPLATE_ARRAY_LENGTH = 114,
  /**
   * This build leaves the template's kernel out.
   */
  COBRA_STATUS_TEMPLATE_KERNEL_LEFT_OUT = 115,
  /**
   * This build leaves the template's metric out.
   */
  COBRA_STATUS_TEMPLATE_METRIC_LEFT_OUT = 116,
  /**
   * There is no component.
   */
  COBRA_STATUS_TEMPLATE_NO_COMPONENTS = 117,
  /**
   * A component has no term.
   */
  COBRA_STATUS_TEMPLATE_NO_TERMS = 118,
  /**
   * The components' terms do not follow each other, or are missing.
   */
  COBRA_STATUS_TEMPLATE_TERM_RANGE = 119,
  /**
   * Terms belong to no component.
   */
  COBRA_STATUS_TEMPLATE_UNUSED_TERMS = 120,
  /**
   * A number that describes the object is out of its range.
   */
  COBRA_STATUS_TEMPLATE_OBJECT_NUMBER = 121,
  /**
   * A number of a component is out of its range.
   */
  COBRA_STATUS_TEMPLATE_COMPONENT_NUMBER = 122,
  /**
   * A weight is not finite.
   */
  COBRA_STATUS_TEMPLATE_WEIGHT = 123,
  /**
   * A direction is no unit vector.
   */
  COBRA_STATUS_TEMPLATE_DIRECTION = 124,
  /**
   * A direction's angles are out of their range.
   */
  COBRA_STATUS_TEMPLATE_ANGLES = 125,
  /**
   * There are not as many precisions as components.
   */
  COBRA_STATUS_TEMPLATE_PRECISION_COUNT = 126,
  /**
   * A precision's factor is not finite or has no positive diagonal.
   */
  COBRA_STATUS_TEMPLATE_PRECISION = 127,
  /**
   * Compact terms have no metric of angles.
   */
  COBRA_STATUS_TEMPLATE_COMPACT_ANGLES = 128,
  /**
   * There are not as many validities as components.
   */
  COBRA_STATUS_TEMPLATE_VALIDITY_COUNT = 129,
  /**
   * A component's box is empty or leaves its grid.
   */
  COBRA_STATUS_TEMPLATE_VALIDITY_BOX = 130,
  /**
   * A component's grid of directions is not one that there is.
   */
  COBRA_STATUS_TEMPLATE_VALIDITY_GRID = 131,
  /**
   * The components' cells do not follow each other, or are missing.
   */
  COBRA_STATUS_TEMPLATE_VALIDITY_RANGE = 132,
  /**
   * A component's cells are malformed, or none is valid.
   */
  COBRA_STATUS_TEMPLATE_VALIDITY_CELLS = 133,
  /**
   * Cells belong to no component.
   */
  COBRA_STATUS_TEMPLATE_UNUSED_CELLS = 134,
  /**
   * Maps have no validity that says where they hold.
   */
  COBRA_STATUS_TEMPLATE_MAP_VALIDITY = 135,
  /**
   * A component's map has not the nodes, the size or the pole that it must have.
   */
  COBRA_STATUS_TEMPLATE_MAP_GRID = 136,
  /**
   * A number of the depth section is out of its range.
   */
  COBRA_STATUS_TEMPLATE_DEPTH_NUMBER = 137,
  /**
   * An entry of the camera matrix is not finite.
   */
  COBRA_STATUS_CAMERA_NOT_FINITE = 200,
  /**
   * A focal length is not positive.
   */
  COBRA_STATUS_CAMERA_FOCAL_LENGTH = 201,
  /**
   * The camera matrix does not have the form (fx s cx; 0 fy cy; 0 0 1).
   */
  COBRA_STATUS_CAMERA_SHAPE = 202,
  /**
   * A coefficient of lens distortion is not 0.
   */
  COBRA_STATUS_CAMERA_DISTORTED = 203,
  /**
   * An entry of R or t is not finite.
   */
  COBRA_STATUS_POSE_NOT_FINITE = 300,
  /**
   * R is no rotation.
   */
  COBRA_STATUS_POSE_NOT_A_ROTATION = 301,
  /**
   * R mirrors.
   */
  COBRA_STATUS_POSE_REFLECTION = 302,
  /**
   * The template has more components than this build's scorer has room for.
   */
  COBRA_STATUS_SCORE_TOO_MANY_COMPONENTS = 400,
  /**
   * The tolerance is not a positive number.
   */
  COBRA_STATUS_SCORE_DELTA = 401,
  /**
   * The fixed sigma is not a positive number.
   */
  COBRA_STATUS_SCORE_SIGMA = 402,
  /**
   * The measurement noise is not a number of at least 0.
   */
  COBRA_STATUS_SCORE_NOISE = 403,
  /**
   * The settings' `likelihood` is no CobraLikelihood.
   */
  COBRA_STATUS_SETTINGS_LIKELIHOOD = 404,
  /**
   * The settings' `assignment` is no CobraAssignment.
   */
  COBRA_STATUS_SETTINGS_ASSIGNMENT = 405,
  /**
   * The settings' `sigma_kind` is no CobraSigmaKind.
   */
  COBRA_STATUS_SETTINGS_SIGMA_KIND = 406,
  /**
   * The settings' `threshold` is no CobraThreshold.
   */
  COBRA_STATUS_SETTINGS_THRESHOLD = 407,
  /**
   * The depth settings' `noise_kind` is no CobraNoiseKind.
   */
  COBRA_STATUS_SETTINGS_NOISE_KIND = 408,
  /**
   * The depth settings' `has_thresholds` is neither 0 nor 1.
   */
  COBRA_STATUS_SETTINGS_HAS_THRESHOLDS = 409,
  /**
   * The template's components may speak everywhere: it does not say where its surface is.
   */
  COBRA_STATUS_DEPTH_NO_VALIDITY = 500,
  /**
   * The measurement noise is not a positive number at the object's depth.
   */
  COBRA_STATUS_DEPTH_NOISE = 501,
  /**
   * The depth buffer has fewer than 8 or more than 256 cells along a side.
   */
  COBRA_STATUS_DEPTH_SIDE = 502,
  /**
   * Refinement has no pixel a step.
   */
  COBRA_STATUS_DEPTH_STEP_PIXELS = 503,
  /**
   * The thresholds are not 0 <= reject <= accept <= 1.
   */
  COBRA_STATUS_DEPTH_THRESHOLDS = 504,
  /**
   * The depth image has no column, or its scale is not a positive number.
   */
  COBRA_STATUS_DEPTH_IMAGE = 505,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraStatus CobraStatus;
#else
typedef uint32_t CobraStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The unit of a template's lengths.
 */
enum CobraUnit
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * 1 mm.
   */
  COBRA_UNIT_MILLIMETRE = 0,
  /**
   * 10 mm.
   */
  COBRA_UNIT_CENTIMETRE = 1,
  /**
   * 1,000 mm.
   */
  COBRA_UNIT_METRE = 2,
  /**
   * 25.4 mm.
   */
  COBRA_UNIT_INCH = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraUnit CobraUnit;
#else
typedef uint32_t CobraUnit;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What to do with the pose. 0 is no answer, so that a report of zeros accepts nothing.
 */
enum CobraDecision
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The input does not allow an answer.
   */
  COBRA_DECISION_UNDECIDED = 0,
  /**
   * The confidence does not reach the threshold.
   */
  COBRA_DECISION_REJECT = 1,
  /**
   * The confidence reaches the threshold.
   */
  COBRA_DECISION_ACCEPT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraDecision CobraDecision;
#else
typedef uint32_t CobraDecision;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Why. New reasons are appended.
 */
enum CobraReason
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Undecided: the call failed, nothing was scored.
   */
  COBRA_REASON_NOT_SCORED = 0,
  /**
   * Accept: the confidence reaches the threshold.
   */
  COBRA_REASON_REACHES_THRESHOLD = 1,
  /**
   * Reject: the confidence lies below the threshold.
   */
  COBRA_REASON_BELOW_THRESHOLD = 2,
  /**
   * Reject: no point lies on the surface.
   */
  COBRA_REASON_NO_SUPPORT = 3,
  /**
   * Reject: every point lies behind the camera.
   */
  COBRA_REASON_BEHIND_CAMERA = 4,
  /**
   * Undecided: fewer points of positive weight than `minimum_points`.
   */
  COBRA_REASON_TOO_FEW_POINTS = 5,
  /**
   * Undecided: the weights add up to zero or next to nothing.
   */
  COBRA_REASON_NO_WEIGHT = 6,
  /**
   * Undecided: a number in the input is not finite.
   */
  COBRA_REASON_NON_FINITE_INPUT = 7,
  /**
   * Undecided: a weight is negative.
   */
  COBRA_REASON_NEGATIVE_WEIGHT = 8,
  /**
   * Undecided: the threshold is zero, the tolerance is immense against sigma.
   */
  COBRA_REASON_NO_THRESHOLD = 9,
  /**
   * Undecided: something in front hides the object.
   */
  COBRA_REASON_HIDDEN = 10,
  /**
   * Undecided: no threshold is known, calibrate first.
   */
  COBRA_REASON_NOT_CALIBRATED = 11,
  /**
   * Undecided: the confidence lies between the thresholds.
   */
  COBRA_REASON_BETWEEN_THRESHOLDS = 12,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraReason CobraReason;
#else
typedef uint32_t CobraReason;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Why a pose fits as it does: a hint for people, which no decision depends on. New causes are
 * appended.
 */
enum CobraCause
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The call failed, nothing was checked.
   */
  COBRA_CAUSE_NOT_CHECKED = 0,
  /**
   * Nothing stands out.
   */
  COBRA_CAUSE_FITS = 1,
  /**
   * The object would lie behind the camera, or around it.
   */
  COBRA_CAUSE_BEHIND_CAMERA = 2,
  /**
   * Measured depths are `cause_value` times those that the pose says, a ratio of units.
   */
  COBRA_CAUSE_SCALE = 3,
  /**
   * Another object stands in front of nearly all of it.
   */
  COBRA_CAUSE_IN_FRONT = 4,
  /**
   * The camera sees past most of what would have to hide the background.
   */
  COBRA_CAUSE_SEEN_THROUGH = 5,
  /**
   * It would have to move along the camera's ray by `cause_value`, negative towards the camera.
   */
  COBRA_CAUSE_ALONG_RAY = 6,
  /**
   * It would have to move across the ray by `cause_value`.
   */
  COBRA_CAUSE_SIDEWAYS = 7,
  /**
   * It would have to turn by `cause_value`, in radians.
   */
  COBRA_CAUSE_TURNED = 8,
  /**
   * What was observed lies on the surface, and the pose does not: refinement finds no way there.
   */
  COBRA_CAUSE_ELSEWHERE = 9,
  /**
   * Little of it can be seen behind something else.
   */
  COBRA_CAUSE_HIDDEN = 10,
  /**
   * Nothing was measured where it must be seen, or that lies outside of the image.
   */
  COBRA_CAUSE_UNMEASURED = 11,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraCause CobraCause;
#else
typedef uint32_t CobraCause;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Which standard deviation a residual has.
 */
enum CobraSigmaKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The template's own, combined with the measurement's in `sigma`, which may be 0.
   */
  COBRA_SIGMA_KIND_TEMPLATE = 0,
  /**
   * The one in `sigma`, for every component.
   */
  COBRA_SIGMA_KIND_FIXED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraSigmaKind CobraSigmaKind;
#else
typedef uint32_t CobraSigmaKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Which likelihood a residual has.
 */
enum CobraLikelihood
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Between 0 and 1: 1 for a residual of 0.
   */
  COBRA_LIKELIHOOD_PEAK = 0,
  /**
   * The Gaussian density, in 1/length.
   */
  COBRA_LIKELIHOOD_DENSITY = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraLikelihood CobraLikelihood;
#else
typedef uint32_t CobraLikelihood;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Which component speaks for a point.
 */
enum CobraAssignment
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The nearest.
   */
  COBRA_ASSIGNMENT_NEAREST = 0,
  /**
   * The one that finds the point most probable.
   */
  COBRA_ASSIGNMENT_MAXIMUM = 1,
  /**
   * All of them, mixed.
   */
  COBRA_ASSIGNMENT_SOFT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraAssignment CobraAssignment;
#else
typedef uint32_t CobraAssignment;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What the threshold promises of a pose within the tolerance.
 */
enum CobraThreshold
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The paper's: a lower bound of the average confidence of such poses.
   */
  COBRA_THRESHOLD_PAPER = 0,
  /**
   * That average itself.
   */
  COBRA_THRESHOLD_MEAN = 1,
  /**
   * Every pose with all residuals within the tolerance passes.
   */
  COBRA_THRESHOLD_WORST = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraThreshold CobraThreshold;
#else
typedef uint32_t CobraThreshold;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What the noise of a measurement follows.
 */
enum CobraNoiseKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A share of the object's diameter: `noise_share`.
   */
  COBRA_NOISE_KIND_SHARE = 0,
  /**
   * The sensor: noise_constant + noise_linear z + noise_quadratic z^2 at the object's depth z.
   */
  COBRA_NOISE_KIND_SENSOR = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum CobraNoiseKind CobraNoiseKind;
#else
typedef uint32_t CobraNoiseKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A pose that is being scored, in memory of the caller's.
 */
typedef struct CobraScorer CobraScorer;

/**
 * A template that was checked, in memory of the caller's. It borrows its bytes.
 */
typedef struct CobraTemplate CobraTemplate;

/**
 * What a template says of itself.
 */
typedef struct CobraTemplateInfo {
  /**
   * The unit of every length.
   */
  CobraUnit unit;
  /**
   * How many millimetres that is.
   */
  float millimetres_per_unit;
  /**
   * The centre of the object's bounding sphere, in the object's frame.
   */
  float centre[3];
  /**
   * The radius of that sphere.
   */
  float radius;
  /**
   * The largest distance between two points of the object.
   */
  float diameter;
  /**
   * How many components there are; `cobra_max_components` says how many a scorer takes.
   */
  uint32_t components;
  /**
   * How many terms all components have together.
   */
  uint32_t terms;
  /**
   * The most kernel evaluations that one point needs with the nearest component.
   */
  uint32_t cost_nearest;
  /**
   * How many it needs with the maximum, and at most with the mixture.
   */
  uint32_t cost_maximum;
  /**
   * The object's name, UTF-8, ends with a zero.
   */
  char name[COBRA_NAME_SIZE];
} CobraTemplateInfo;

/**
 * Where and by how much a template is wrong: `COBRA_NOT_APPLICABLE`, and 0 for `value`, where the
 * status has no such number.
 */
typedef struct CobraTemplateDetail {
  /**
   * What is wrong.
   */
  CobraStatus status;
  /**
   * The section's tag, as the template format numbers sections.
   */
  uint32_t section;
  /**
   * Which component, from 0.
   */
  uint32_t component;
  /**
   * Which of its terms, from 0.
   */
  uint32_t term;
  /**
   * The number that was expected.
   */
  uint32_t expected;
  /**
   * The number that was found.
   */
  uint32_t found;
  /**
   * The number that was found, where it is no integer.
   */
  float value;
} CobraTemplateDetail;

/**
 * The object's pose in the camera's frame: a point P of the object is seen at RP + t. The camera
 * looks along +Z, x to the right and y down (OpenCV, BOP).
 */
typedef struct CobraPose {
  /**
   * R, row by row.
   */
  float rotation[9];
  /**
   * t, in the template's unit.
   */
  float translation[3];
} CobraPose;

/**
 * How points are scored. Fill it with `cobra_settings_default` and change what is to be changed:
 * one that is all zeros is refused, because its tolerance is 0.
 */
typedef struct CobraSettings {
  /**
   * The tolerance above 0, in the template's unit.
   */
  float delta;
  /**
   * A CobraSigmaKind: what `sigma` is.
   */
  uint32_t sigma_kind;
  /**
   * The measurement's standard deviation, or the fixed one, in the template's unit.
   */
  float sigma;
  /**
   * A CobraLikelihood.
   */
  uint32_t likelihood;
  /**
   * A CobraAssignment.
   */
  uint32_t assignment;
  /**
   * A CobraThreshold.
   */
  uint32_t threshold;
  /**
   * With fewer points of positive weight than this the decision is undecided.
   */
  uint32_t minimum_points;
} CobraSettings;

/**
 * The intrinsics of a pinhole camera.
 */
typedef struct CobraCamera {
  /**
   * The matrix K = (fx s cx; 0 fy cy; 0 0 1), row by row, in pixels.
   */
  float matrix[9];
} CobraCamera;

/**
 * One observed pixel and the point on the object that the estimator assigns to it.
 */
typedef struct CobraCorrespondence {
  /**
   * The pixel's column, pixel centres at integers.
   */
  float u;
  /**
   * The pixel's row.
   */
  float v;
  /**
   * The point in the object's frame and the template's unit.
   */
  float x;
  /**
   * See `x`.
   */
  float y;
  /**
   * See `x`.
   */
  float z;
  /**
   * The weight, at least 0; 1 for every point is the plain average.
   */
  float weight;
} CobraCorrespondence;

/**
 * The scorer's answer. None of its numbers is ever NaN.
 */
typedef struct CobraReport {
  /**
   * The weighted mean likelihood of the points.
   */
  float confidence;
  /**
   * The threshold for it.
   */
  float threshold;
  /**
   * The sum of the weights.
   */
  float weight_sum;
  /**
   * The share of the points whose residual is at most the tolerance.
   */
  float inlier_share;
  /**
   * How many correspondences were pushed.
   */
  uint32_t points;
  /**
   * How many of them came to lie behind the camera.
   */
  uint32_t behind_camera;
  /**
   * What to do.
   */
  CobraDecision decision;
  /**
   * Why.
   */
  CobraReason reason;
  /**
   * How many came to lie where no component speaks for them.
   */
  uint32_t uncovered;
} CobraReport;

/**
 * How a pose is checked against depth. Fill it with `cobra_depth_settings_default` and change what
 * is to be changed: one that is all zeros is refused, because its depth buffer has no cells.
 */
typedef struct CobraDepthSettings {
  /**
   * A CobraNoiseKind.
   */
  uint32_t noise_kind;
  /**
   * The share of the diameter, above 0.
   */
  float noise_share;
  /**
   * Of the sensor's noise, in the template's unit.
   */
  float noise_constant;
  /**
   * Of the sensor's noise, a share of the depth.
   */
  float noise_linear;
  /**
   * Of the sensor's noise, in 1/unit.
   */
  float noise_quadratic;
  /**
   * Whether there are thresholds, 0 or 1; without them no pose is accepted.
   */
  uint32_t has_thresholds;
  /**
   * From this confidence on a pose is accepted.
   */
  float accept;
  /**
   * Below this it is rejected; not above `accept`.
   */
  float reject;
  /**
   * With fewer observed pixels, or fewer points of the surface that the depth says something of,
   * the decision is undecided.
   */
  uint32_t minimum_points;
  /**
   * Cells along a side of the depth buffer, 8 to 256.
   */
  uint16_t side;
  /**
   * How often the pose is refined.
   */
  uint16_t steps;
  /**
   * How many observed pixels a step uses at most, at least 1.
   */
  uint16_t step_pixels;
} CobraDepthSettings;

/**
 * A pixel that shows the object, as a mask says, and the depth measured there.
 */
typedef struct CobraDepthPixel {
  /**
   * Column, from 0; pixel centres are at integers.
   */
  uint16_t column;
  /**
   * Row, from 0.
   */
  uint16_t row;
  /**
   * The depth along the camera's axis, in the template's unit; 0 where nothing was measured.
   */
  float depth;
} CobraDepthPixel;

/**
 * What was observed.
 */
typedef struct CobraDepthObserved {
  /**
   * The object's pixels; NULL for those in which the pose itself says that it is seen.
   */
  const struct CobraDepthPixel *pixels;
  /**
   * How many there are; 0 with NULL.
   */
  size_t pixel_count;
  /**
   * The depth image, `height` rows of `width` words behind each other; 0 where nothing was
   * measured.
   */
  const uint16_t *words;
  /**
   * Columns, at least 1.
   */
  uint16_t width;
  /**
   * Rows.
   */
  uint16_t height;
  /**
   * What a word is multiplied by to be in the template's unit, above 0.
   */
  float scale;
  /**
   * Called with `context` at least once every 64 pixels, cells, or places where a point of the surface
   * may be: where a watchdog can be fed. NULL for nobody.
   */
  void (*alive)(void*);
  /**
   * What `alive` is called with.
   */
  void *context;
} CobraDepthObserved;

/**
 * The answer of a check against depth. None of its numbers is ever NaN; lengths are in the
 * template's unit.
 */
typedef struct CobraDepthReport {
  /**
   * exp(-estimated_error^2/2 noise^2), the least of three likelihoods, from 0 to 1; 0 where it would rest on
   * fewer than `minimum_points`.
   */
  float confidence;
  /**
   * The mean likelihood of the observed pixels, put back onto the surface.
   */
  float forward;
  /**
   * The mean likelihood of the surface that must be visible.
   */
  float reverse;
  /**
   * How far the pose is estimated to be off.
   */
  float estimated_error;
  /**
   * How far refinement moves the object's points, on average.
   */
  float displacement;
  /**
   * The rms distance of the observed pixels from the surface after refinement.
   */
  float residual;
  /**
   * The standard deviation that distances were compared with.
   */
  float noise;
  /**
   * Measured depths over those that the pose says; 0 without any.
   */
  float depth_ratio;
  /**
   * The pose that refinement leads to: a suggestion.
   */
  struct CobraPose refined;
  /**
   * How many observed pixels had a depth.
   */
  uint32_t pixels;
  /**
   * How many of them nothing of the surface spoke for.
   */
  uint32_t silent;
  /**
   * How many points of the surface must be visible.
   */
  uint32_t visible;
  /**
   * How many of them were evidence, for or against.
   */
  uint32_t judged;
  /**
   * How many were hidden by something nearer.
   */
  uint32_t hidden;
  /**
   * How many lie outside of the image or where nothing was measured.
   */
  uint32_t unmeasured;
  /**
   * How many of the judged ones the camera saw through.
   */
  uint32_t seen_through;
  /**
   * What to do.
   */
  CobraDecision decision;
  /**
   * Why.
   */
  CobraReason reason;
  /**
   * Why the pose fits as it does.
   */
  CobraCause cause;
  /**
   * The cause's number, where it has one, else 0.
   */
  float cause_value;
  /**
   * How far refinement moves the object's middle away from the camera along its ray.
   */
  float moved_along_ray;
  /**
   * How far across the ray.
   */
  float moved_sideways;
  /**
   * By what angle it turns the object, in radians.
   */
  float turned;
} CobraDepthReport;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Exactly how many bytes `cobra_template_load` needs.
 */
size_t cobra_template_size(void);

/**
 * Exactly how those bytes must be aligned.
 */
size_t cobra_template_align(void);

/**
 * The length of the template at the start of `bytes`, from its header alone: flash is padded
 * behind a template, and what is loaded must be exactly as long as the template. `*out` is 0 when
 * the call fails; a length above `length` says that the template is cut off.
 *
 * # Safety
 * `bytes` points to `length` bytes, `out` to a size_t.
 */
CobraStatus cobra_template_peek_length(const uint8_t *bytes, size_t length, size_t *out);

/**
 * Checks `length` bytes, which must be exactly one template, puts a handle into `memory` and tells
 * `out` where it is, or sets `*out` to NULL. The bytes may lie at any address and are not copied.
 *
 * # Safety
 * `memory` points to `memory_size` writable bytes and `out` to a pointer; `bytes` points to
 * `length` bytes that stay where they are, unchanged, for as long as the handle is used.
 */
CobraStatus cobra_template_load(void *memory,
                                size_t memory_size,
                                const uint8_t *bytes,
                                size_t length,
                                struct CobraTemplate **out);

/**
 * What a template says of itself.
 *
 * # Safety
 * `template` was loaded and its bytes are still there; `out` points to a CobraTemplateInfo.
 */
CobraStatus cobra_template_info(const struct CobraTemplate *template_,
                                struct CobraTemplateInfo *out);

/**
 * Where and by how much bytes are wrong that `cobra_template_load` refuses: they are checked once
 * more. Where nothing is wrong with them, `out->status` is `COBRA_STATUS_OK`.
 *
 * # Safety
 * `bytes` points to `length` bytes, `out` to a CobraTemplateDetail.
 */
CobraStatus cobra_template_explain(const uint8_t *bytes,
                                   size_t length,
                                   struct CobraTemplateDetail *out);

/**
 * Refuses lens distortion: `COBRA_STATUS_CAMERA_DISTORTED` unless all `count` coefficients are 0.
 * Distortion is not modelled, so undistort the image points first. `coefficients` may be NULL
 * where `count` is 0.
 *
 * # Safety
 * `coefficients` points to `count` numbers.
 */
CobraStatus cobra_check_distortion(const float *coefficients, size_t count);

/**
 * Replaces R by the nearest rotation, for a pose that comes with few digits or from a file whose
 * matrix is off: the scorer itself refuses what is no rotation. A matrix that is too far off is
 * refused here too, and then the pose is left as it was.
 *
 * # Safety
 * `pose` points to a CobraPose.
 */
CobraStatus cobra_pose_orthonormalise(struct CobraPose *pose);

/**
 * Exactly how many bytes `cobra_scorer_start` needs.
 */
size_t cobra_scorer_size(void);

/**
 * Exactly how those bytes must be aligned.
 */
size_t cobra_scorer_align(void);

/**
 * The most components that a template may have to be scored by this build: 32, unless
 * COBRA_MAX_COMPONENTS was set when the library was built.
 */
size_t cobra_max_components(void);

/**
 * The defaults: peak likelihood, nearest component, the template's sigma without measurement
 * noise, the paper's threshold, at least 10 points, and a tolerance in millimetres, whatever the
 * template's unit. That the tolerance is above 0 is checked by `cobra_scorer_start`.
 *
 * # Safety
 * `template` was loaded and its bytes are still there; `out` points to a CobraSettings.
 */
CobraStatus cobra_settings_default(const struct CobraTemplate *template_,
                                   float delta_millimetres,
                                   struct CobraSettings *out);

/**
 * Starts on a pose: puts a scorer into `memory` and tells `out` where it is, or sets `*out` to
 * NULL. Camera, pose and settings are copied; the template is borrowed. The same memory serves
 * pose after pose.
 *
 * # Safety
 * `memory` points to `memory_size` writable bytes; `template` was loaded, and it and its bytes
 * stay where they are, unchanged, for as long as the scorer is used; the other pointers point to
 * what their types say.
 */
CobraStatus cobra_scorer_start(void *memory,
                               size_t memory_size,
                               const struct CobraTemplate *template_,
                               const struct CobraCamera *camera,
                               const struct CobraPose *pose,
                               const struct CobraSettings *settings,
                               struct CobraScorer **out);

/**
 * Takes one correspondence and, where `likelihood` is not NULL, tells its likelihood: 0 for a
 * point behind the camera or with invalid numbers. A number that is not finite or a negative
 * weight is no failure of the call: it makes the decision undecided. When the call fails, the
 * correspondence is not counted.
 *
 * # Safety
 * `scorer` was started and nobody else uses it meanwhile; `correspondence` and, unless NULL,
 * `likelihood` point to what their types say.
 */
CobraStatus cobra_scorer_push(struct CobraScorer *scorer,
                              const struct CobraCorrespondence *correspondence,
                              float *likelihood);

/**
 * The confidence, the threshold and the decision on everything pushed so far; more may be pushed
 * afterwards. When the call fails and `report` can be written, it says undecided.
 *
 * # Safety
 * `scorer` was started and nobody pushes meanwhile; `report` points to a CobraReport.
 */
CobraStatus cobra_scorer_finish(const struct CobraScorer *scorer, struct CobraReport *report);

/**
 * What the template knows: its measurement noise, and its thresholds where it was calibrated. The
 * rest: a depth buffer of 32 by 32 cells, four steps on at most 150 pixels; at least 10 points, or as many
 * as it was calibrated with.
 *
 * # Safety
 * `template` was loaded and its bytes are still there; `out` points to a CobraDepthSettings.
 */
CobraStatus cobra_depth_settings_default(const struct CobraTemplate *template_,
                                         struct CobraDepthSettings *out);

/**
 * Exactly how many bytes of scratch memory `cobra_depth_check` needs with these settings, into
 * `out`; 0 when the call fails. It is `COBRA_DEPTH_CELL_SIZE` for each of the buffer's cells.
 *
 * # Safety
 * `settings` points to a CobraDepthSettings, `out` to a size_t.
 */
CobraStatus cobra_depth_memory_size(const struct CobraDepthSettings *settings, size_t *out);

/**
 * Exactly how those bytes must be aligned.
 */
size_t cobra_depth_memory_align(void);

/**
 * Checks a pose against what a depth camera saw, both ways: whether the observed pixels lie on the
 * object's surface, and whether the surface that the pose says is visible was seen. When the call
 * fails and `report` can be written, it says undecided. Nothing is kept: the memory, whatever it
 * holds, is scratch, and free again when the call returns.
 *
 * # Safety
 * `memory` points to `memory_size` writable bytes that nobody uses meanwhile; `template` was loaded
 * and its bytes are still there; the other pointers, those in `observed` too, point to what their
 * types say.
 */
CobraStatus cobra_depth_check(void *memory,
                              size_t memory_size,
                              const struct CobraTemplate *template_,
                              const struct CobraCamera *camera,
                              const struct CobraPose *pose,
                              const struct CobraDepthSettings *settings,
                              const struct CobraDepthObserved *observed,
                              struct CobraDepthReport *report);

/**
 * What a status says, as a phrase. Never NULL, also for a number that is no CobraStatus.
 */
const char *cobra_status_string(uint32_t status);

/**
 * `accept`, `reject` or `undecided`. Never NULL, also for a number that is no CobraDecision.
 */
const char *cobra_decision_string(uint32_t decision);

/**
 * What a reason says, as a phrase. Never NULL, also for a number that is no CobraReason.
 */
const char *cobra_reason_string(uint32_t reason);

/**
 * What a cause says, as a phrase; its number is in the report. Never NULL, also for a number that is
 * no CobraCause.
 */
const char *cobra_cause_string(uint32_t cause);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* COBRA_INFER_H */
