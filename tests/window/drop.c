/* drop WINDOW URI: drops a file on a window as a file manager does (XDND 5, one type). Exit code 0 when it was taken. */
#include <X11/Xlib.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TRIES = 250 };
static const struct timespec PAUSE = {.tv_nsec = 20000000};

struct drop {
    Display *display;
    Window source, target;
    const char *uri;
    Bool dropped, finished;
};

static Atom atom(const struct drop *drop, const char *name)
{
    return XInternAtom(drop->display, name, False);
}

static void tell(const struct drop *drop, const char *type, long b, long c, long d, long e)
{
    XEvent event = {.xclient = {.type = ClientMessage,
                                .window = drop->target,
                                .message_type = atom(drop, type),
                                .format = 32,
                                .data.l = {(long)drop->source, b, c, d, e}}};

    XSendEvent(drop->display, drop->target, False, NoEventMask, &event);
    XFlush(drop->display);
}

/* The target asks for what is dropped. */
static void hand_over(const struct drop *drop, const XSelectionRequestEvent *request)
{
    XEvent answer = {.xselection = {.type = SelectionNotify,
                                    .requestor = request->requestor,
                                    .selection = request->selection,
                                    .target = request->target,
                                    .property = request->property,
                                    .time = request->time}};

    XChangeProperty(drop->display, request->requestor, request->property, request->target, 8, PropModeReplace,
                    (const unsigned char *)drop->uri, (int)strlen(drop->uri));
    XSendEvent(drop->display, request->requestor, False, NoEventMask, &answer);
    XFlush(drop->display);
}

static void take(struct drop *drop, const XEvent *event)
{
    if (event->type == SelectionRequest)
        hand_over(drop, &event->xselectionrequest);
    if (event->type != ClientMessage)
        return;
    if (event->xclient.message_type == atom(drop, "XdndStatus") && !drop->dropped) {
        drop->dropped = True;
        tell(drop, "XdndDrop", 0, CurrentTime, 0, 0);
    }
    drop->finished = drop->finished || event->xclient.message_type == atom(drop, "XdndFinished");
}

int main(int argc, char **argv)
{
    struct drop drop = {.display = argc == 3 ? XOpenDisplay(NULL) : NULL};

    if (!drop.display)
        return 2;
    drop.target = strtoul(argv[1], NULL, 0);
    drop.uri = argv[2];
    drop.source = XCreateSimpleWindow(drop.display, DefaultRootWindow(drop.display), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(drop.display, atom(&drop, "XdndSelection"), drop.source, CurrentTime);
    tell(&drop, "XdndEnter", 5l << 24, (long)atom(&drop, "text/uri-list"), 0, 0);
    tell(&drop, "XdndPosition", 0, 100l << 16 | 100, CurrentTime, (long)atom(&drop, "XdndActionCopy"));
    for (int i = 0; i < TRIES && !drop.finished; i++) {
        while (XPending(drop.display)) {
            XEvent event;

            XNextEvent(drop.display, &event);
            take(&drop, &event);
        }
        nanosleep(&PAUSE, NULL);
    }
    XCloseDisplay(drop.display);
    return drop.finished ? 0 : 1;
}
