"""python3 -m pendres.explorer [FILE.h5]: serve the explorer on this machine, and open it."""
import argparse
import hmac
import secrets
import sys


def _options(given):
    parser = argparse.ArgumentParser(prog="python3 -m pendres.explorer", description=(
        "Turn knobs and see what a driven oscillator does. The page is served on this machine "
        "alone, and only to who has the address that is printed."))
    parser.add_argument("file", nargs="?", help="a file of results to look at; a click in it sets "
                        "the knobs")
    parser.add_argument("--port", type=int, default=0, help="default: any that is free")
    parser.add_argument("--no-browser", action="store_true", help="print the address alone")
    return parser.parse_args(given)


def _door(token):
    """Who has the token gets in, and a cookie that keeps it; nobody else."""
    from bokeh.server.auth_provider import AuthProvider
    from tornado.web import RequestHandler

    class Closed(RequestHandler):
        """What anybody else sees."""

        def get(self):
            self.set_status(403)
            self.finish("The address that the explorer has printed, with its token, is needed.")

    def user(handler):
        cookie = f"pendres-{handler.request.host.rpartition(':')[2]}"
        given = handler.get_argument("token", None)
        if given is not None and hmac.compare_digest(given.encode(), token.encode()):
            handler.set_cookie(cookie, token, httponly=True, samesite="Strict")
            return "owner"
        kept = handler.get_cookie(cookie) or ""
        return "owner" if hmac.compare_digest(kept.encode(), token.encode()) else None

    class Door(AuthProvider):
        """Bokeh asks it for each page and each connection."""

        get_user = property(lambda _self: user)
        get_user_async = get_login_url = logout_url = logout_handler = property(lambda _self: None)
        login_url = property(lambda _self: "/closed")
        login_handler = property(lambda _self: Closed)

    return Door()


def main(given=None):
    """Serve until Ctrl-C."""
    options = _options(given)
    try:
        import panel as pn
    except ImportError:
        sys.exit("the explorer needs panel and bokeh: pip install 'pendres[explorer]', or pip "
                 "install panel")
    from bokeh.server.util import bind_sockets
    from .page import CSS, DARK, Page
    from .results import Results
    results = None
    if options.file:
        try:
            results = Results(options.file)
        except (OSError, ValueError, ImportError) as why:
            sys.exit(f"{options.file}: {why}")
    pn.extension(raw_css=[CSS], notifications=True, disconnect_notification=(
        "The explorer has ended. Start it again: python3 -m pendres.explorer"))

    def page():
        found = Page(results)
        style = pn.pane.HTML(f"<style>{DARK if found.dark else ''}</style>", height=0, margin=0)
        return pn.Column(style, found.view(), sizing_mode="stretch_width")

    try:
        sockets, port = bind_sockets("127.0.0.1", options.port)
    except OSError as why:
        sys.exit(f"port {options.port}: {why}")
    for socket in sockets:
        socket.close()
    token = secrets.token_urlsafe(24)
    address = f"http://127.0.0.1:{port}/?token={token}"
    server = pn.serve({"/": page}, address="127.0.0.1", port=port, show=False, start=False,
                      title="pendres explorer", auth_provider=_door(token),
                      websocket_origin=[f"127.0.0.1:{port}", f"localhost:{port}"], verbose=False)
    # Not before the port is ours: who else has it would be told the token.
    print(f"The explorer is at {address}\nCtrl-C ends it.", flush=True)
    if not options.no_browser:
        import webbrowser
        server.io_loop.add_callback(lambda: webbrowser.open(address))
    try:
        server.start()
        server.io_loop.start()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
