/* Models as streams: the text and the binary encoding of sinew-model(5). A reader sniffs which one it has.
 * Frames come one at a time. Readers and writers borrow their streams; the caller closes those.
 */
#ifndef SINEW_STREAM_H
#define SINEW_STREAM_H

#include "base/in.h"
#include "base/out.h"
#include "model/model.h"

enum { MODEL_FAIL_MOST = 999 }; /* bytes of the text of a `fail` */

typedef struct model_reader model_reader;
typedef struct model_writer model_writer;

/* Reads the first line or magic. NULL with e filled; on zero bytes e says so and names `sinew bind`. */
model_reader *model_reader_open(in *s, err *e);
void model_reader_close(model_reader *r);

/* For those who take the frames before a cut: what a first frame has to have nothing says, so where the stream is cut
 * behind one of its arrays, or within an item that is none, it is given as it is, and the cut is the next frame's
 * error. (Else it is its own.) */
void model_reader_give_cut(model_reader *r);

/* For a caller that wants only names, and quickly: the values of long arrays are neither kept (their data is NULL) nor
 * checked, and a long text or gzip stream is an error. */
void model_reader_names(model_reader *r);

/* For a stream that goes on with what is no model: what follows the model's end is left to the caller, and not waited
 * for. (Else it is an error.) */
void model_reader_let_follow(model_reader *r);

/* The body, all of it, checked. A stream that ended with `fail` gives -1 with e filled: the status and text as they
 * came, e->silent set. */
int model_read(model_reader *r, model *m, err *e);

/* The next frame, into f (freed and filled again). m: the model that the frame is to fit; NULL: as the stream's own
 * body says. 1: a frame; 0: the end, nothing follows it; -1: e filled. */
int model_read_frame(model_reader *r, const model *m, frame *f, err *e);

/* text: the text encoding. Nothing is written yet. NULL with e filled. */
model_writer *model_writer_open(out *o, bool text, err *e);
void model_writer_close(model_writer *w);

/* Errors of writing stick in the out and show at out_close. What a reader would refuse is refused
 * here, before a byte of it is written. */
int model_write(model_writer *w, const model *m, err *e);

/* Writes the body's beginning, all but its arrays and blocks, and its first `arrays` arrays. model_write of the model,
 * which may have got more arrays after these, then writes the rest: together the same bytes. */
int model_write_ahead(model_writer *w, const model *m, int arrays, err *e);

int model_write_frame(model_writer *w, const frame *f, err *e);
int model_write_end(model_writer *w, err *e);
/* Ends the stream with `fail STATUS "text"`, wherever it stood. A longer text is cut; bytes that are not UTF-8 become
 * '?'. */
int model_write_fail(model_writer *w, int status, const char *text, err *e);

#endif
