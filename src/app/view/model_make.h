/* Inside of model.c: a scene made of text and sets, what is to take the model's place, and which of its sets are of use. */
#ifndef SF_APP_VIEW_MODEL_MAKE_H
#define SF_APP_VIEW_MODEL_MAKE_H

#include "model.h"
#include "model_sets.h"

enum { SF_MADE_ERROR_BYTES = 1024 };

struct sf_made {
    struct sf_scene *scene;
    struct sf_control *controls;
    uint32_t count;
    enum sf_status status;
    char error[SF_MADE_ERROR_BYTES]; /* the first one */
};

/* Of file, text and sets; and what the file itself says, as sets of every control (empty when it is no scene without the
 * sets). */
struct sf_next {
    char *path, *text;
    size_t bytes;
    bool shared; /* path, text and own are the model's, and stay so */
    struct sf_sets sets, own;
    struct sf_made made;
    const struct sf_log *log;
};
void sf_next_finish(struct sf_next *next);
/* Makes the scene of what is there, in place of one made before. Errors are kept in made.error and not logged: whether they
 * matter is for the caller. `log` gets warnings; NULL: nobody. */
enum sf_status sf_next_make(struct sf_next *next, const struct sf_log *log);
/* Fills own. False: memory is out. */
bool sf_next_read_own(struct sf_next *next);
/* Takes sets away that say what the file says. False: memory is out. */
bool sf_next_settle(struct sf_next *next);
/* The sets do not make a scene: keeps those of index i where kept[i], and as many others as can be; drops the rest with
 * warnings. False: it is not for them, and nothing changed. `kept` is written over. */
bool sf_next_fit(struct sf_next *next, bool *kept);

#endif
