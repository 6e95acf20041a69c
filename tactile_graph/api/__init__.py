"""What a user holds: ``load``, the `Pipeline` it gives, the `Result` of a frame."""
