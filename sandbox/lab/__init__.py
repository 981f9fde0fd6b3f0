"""The laboratory: what accuracy and speed the engine really has, measured."""
