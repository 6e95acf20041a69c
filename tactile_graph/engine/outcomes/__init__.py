"""What a frame comes to, node by node: values, skips, failures, notices, promises kept."""
