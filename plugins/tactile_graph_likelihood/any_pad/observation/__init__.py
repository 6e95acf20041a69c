"""What an image shows: noise, what is touched, what hangs together, what recordings have taught."""
