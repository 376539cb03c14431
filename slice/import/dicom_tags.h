/* The elements that are read, as PS3.6 names them.
 */
#ifndef SINEW_DICOM_TAGS_H
#define SINEW_DICOM_TAGS_H

#define TAG_SOP_CLASS       0x00080016U
#define TAG_SERIES          0x0020000EU /* SeriesInstanceUID */
#define TAG_BURNED_IN       0x00280301U /* BurnedInAnnotation */
#define TAG_TIME_OFFSET     0x0020930DU /* TemporalPositionTimeOffset */
#define TAG_TIME_INDEX      0x00209128U /* TemporalPositionIndex */
#define TAG_DATA_TYPE       0x00189808U
#define TAG_FRAMES          0x00280008U
#define TAG_ROWS            0x00280010U
#define TAG_COLUMNS         0x00280011U
#define TAG_PIXELS          0x7FE00010U
#define TAG_PIXEL_SPACING   0x00280030U
#define TAG_BETWEEN_SLICES  0x00180088U
#define TAG_DELTA_X         0x0018602CU /* of an ultrasound region */
#define TAG_DELTA_Y         0x0018602EU
#define TAG_UNITS_X         0x00186024U
#define TAG_UNITS_Y         0x00186026U
#define TAG_REGIONS         0x00186011U
#define TAG_POSITION        0x00200032U /* ImagePositionPatient */
#define TAG_ORIENTATION     0x00200037U
#define TAG_POSITION_VOL    0x00209301U /* ImagePositionVolume */
#define TAG_ORIENTATION_VOL 0x00209302U
#define TAG_INTERCEPT       0x00281052U
#define TAG_SLOPE           0x00281053U

#define TAG_SHARED_GROUPS      0x52009229U
#define TAG_FRAME_GROUPS       0x52009230U
#define TAG_GROUP_POSITION_VOL 0x0020930EU
#define TAG_GROUP_TURN_VOL     0x0020930FU
#define TAG_GROUP_POSITION     0x00209113U
#define TAG_GROUP_TURN         0x00209116U
#define TAG_GROUP_TIME         0x00209310U
#define TAG_GROUP_CONTENT      0x00209111U
#define TAG_GROUP_MEASURES     0x00289110U
#define TAG_GROUP_VALUES       0x00289145U
#define TAG_GROUP_DATA_TYPE    0x00189807U
#define TAG_PHILIPS_DEPTH      0x30011001U
#define TAG_PHILIPS_DELTA_Z    0x30011003U
#define PHILIPS_VOLUME         "1.2.840.113543.6.6.1.3.10002"

#define TAG_SAMPLES      0x00280002U
#define TAG_COLOUR       0x00280004U
#define TAG_PLANAR       0x00280006U
#define TAG_ALLOCATED    0x00280100U
#define TAG_STORED       0x00280101U
#define TAG_HIGH_BIT     0x00280102U
#define TAG_SIGNED       0x00280103U
#define TAG_PALETTE      0x00281101U /* the descriptor of red; green and blue follow */
#define TAG_PALETTE_DATA 0x00281201U

#endif
