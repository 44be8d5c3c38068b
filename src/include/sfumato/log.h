/* Where the library's words go. It never prints: the host gives a function, or NULL for silence. */
#ifndef SFUMATO_LOG_H
#define SFUMATO_LOG_H

enum sf_log_level { SF_LOG_ERROR, SF_LOG_WARNING, SF_LOG_INFO, SF_LOG_DEBUG };

/* Called from any thread, one call at a time for each sf_log. `message` is one line without a newline. */
typedef void (*sf_log_fn)(void *user, enum sf_log_level level, const char *message);

/* The caller owns it and keeps it alive as long as anything made with it. A NULL sf_log is silent. */
struct sf_log {
    sf_log_fn write;
    void *user;
    enum sf_log_level level; /* messages above this level are dropped before they are formatted */
};

#endif
