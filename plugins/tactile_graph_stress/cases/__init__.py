"""The cases, one file for each way of feeding a step."""
