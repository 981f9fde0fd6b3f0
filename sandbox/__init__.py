"""tumble's sandbox: scenes, the server loop, the command line. It knows the engine, and no viewer."""
